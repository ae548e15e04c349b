"""The panel that explains a shared step: what each action is worth, which were good enough, and whose it became."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from ai.env import Bools, Doubles, Floats
from ai.ground import Ground
from ai.lander import ACTION_NAMES, NUM_ACTIONS
from ai.pilots import COAST
from game import hud, texts
from game.flight import Flight, Hand
from game.networks import Thinker
from game.ui.canvas import Canvas
from game.ui.kept import Kept
from game.ui.tokens import FAINT, HUMAN, INK, LABEL, LINE, MUTE, NET, SMALL, VIEW_SIZE
from game.world.paint import mix

PANEL: Final = pygame.Rect(VIEW_SIZE[0] - 64 - 244, 84, 264, 336)
PADS_HIGH: Final = 102  # what the rows of three pads add
_LEFT: Final = 20  # of what stands on the panel, from its corner
_WIDTH: Final = PANEL.width - 40
_TRACK: Final = (_LEFT + 96, _WIDTH - 96)
_FIRST: Final = 64
_ROW: Final = 24
_WHY: Final = _FIRST + 6 * _ROW
_PADS: Final = _WHY + 114  # the first pad's row
_EASE: Final = 0.35
_STAYS: Final = 50  # steps that the word on an override is kept, to be read


class Insight:
    """Follows a flight that is shared, or that a network flies; `shown` while there is something to explain."""

    def __init__(self, ground: Ground) -> None:
        self.shown = False
        self._names = [texts.PAD_NAMES.get(pad.factor, "") for pad in ground.pads]
        self._bars: Doubles = np.zeros(NUM_ACTIONS)
        self._wanted: Doubles = np.zeros(NUM_ACTIONS)
        self._feasible: Bools = np.ones(NUM_ACTIONS, dtype=bool)
        self._likely: list[float] = []
        self._asked: int | None = None
        self._flown, self._threshold = COAST, 0.0
        self._why: tuple[str, str, str] = ("", "", "")
        self._kept = 0
        self._seen: object = None
        self._words = Kept()

    def follow(self, flight: Flight) -> None:
        """Note the step just flown."""
        if flight.over:
            return
        self.shown = flight.shared or (flight.hand is Hand.NETWORK and isinstance(flight.network, Thinker))
        self._kept = max(0, self._kept - 1)
        if flight.hand is Hand.NETWORK:
            self._watch(flight)
        elif flight.decision is not None and flight.decision is not self._seen:
            self._explain(flight)
        self._bars += _EASE * (self._wanted - self._bars)

    def _watch(self, flight: Flight) -> None:
        """Ask a network that flies alone what it thinks, whenever it has decided."""
        if not isinstance(flight.network, Thinker) or flight.sensed is None or flight.sensed is self._seen:
            return
        self._seen = flight.sensed
        self._wanted = _worth(flight.network.q_values(flight.sensed)[0])
        self._feasible[:], self._threshold, self._asked = True, 0.0, None
        self._flown, self._likely = flight.recording.actions[-1], []
        self._why, self._kept = texts.INSIGHT_WHY["ALONE"], 0

    def _explain(self, flight: Flight) -> None:
        from ai.copilot import Mode, Rule

        decision, copilot = flight.decision, flight.copilot
        assert decision is not None
        assert copilot is not None
        self._seen = decision
        values = decision.values[0, int(flight.env.target[0])]
        self._wanted = _worth(values)
        self._feasible = decision.feasible[0]
        self._likely = decision.likely[0].tolist()
        asked, best, self._flown = int(decision.pilot[0]), int(decision.best[0]), int(decision.action[0])
        self._asked = None if asked == COAST else asked
        guards = copilot.mode is Mode.GUARDIAN
        if guards and asked != COAST:  # which compares what is asked for with its own, and nothing else
            self._feasible = (np.arange(NUM_ACTIONS) != asked) | decision.feasible[0]
        self._threshold = 0.0 if guards else 1.0 if asked == COAST else copilot.assist
        rule = Rule.HANDS_OFF if asked == COAST else Rule(int(decision.rule[0]))
        if rule is Rule.PILOT and self._kept:
            return  # there is more to be read about the override before
        title, first, second = texts.INSIGHT_WHY[rule.name]
        if guards and asked != COAST:
            points = float(values[best] - values[asked]) / copilot.reward_scale
            changed = rule is not Rule.PILOT
            second = texts.INSIGHT_SAME if asked == best else texts.INSIGHT_GUARDIAN[changed].format(
                points=f"{points:.1f}", best=ACTION_NAMES[best])  # fmt: skip
        words = {"asked": ACTION_NAMES[asked].capitalize(), "worth": round(100 * float(self._wanted[asked])),
                 "assist": round(100 * copilot.assist)}  # fmt: skip
        self._why = (title, first.format(**words), second.format(**words))
        self._kept = _STAYS if rule not in (Rule.PILOT, Rule.HANDS_OFF) else 0

    def draw(self, canvas: Canvas, share: float) -> None:
        """Draw the panel; `share` is the person's share of the flight so far."""
        pads = self._likely if len(self._likely) > 1 else []
        lower, left, top = PADS_HIGH if pads else 0, PANEL.left + _LEFT, PANEL.top
        surest = max(pads, default=0.0)
        shows = self._flown, self._feasible.tobytes(), tuple(chance == surest for chance in pads)
        box = (PANEL.left, top, PANEL.width, PANEL.height + lower)
        self._words.draw(canvas, box, shows, lambda sheet: self._paint_words(sheet, pads))
        for action in range(NUM_ACTIONS):
            self._draw_bar(canvas, action)
        if 0.0 < self._threshold < 1.0:
            x, y = PANEL.left + _TRACK[0] + self._threshold * _TRACK[1], top + _FIRST
            canvas.line((x, y - 9), (x, y + 5 * _ROW + 9), MUTE)
            canvas.marker("triangle_down", (x, y - 13), 6, INK, 0.8)
        title, *lines = self._why
        canvas.text(title, (left, top + _WHY + 26), colour=NET if self._kept else INK)
        for number, line in enumerate(lines):
            canvas.text(line, (left, top + _WHY + 48 + 18 * number), size=SMALL, colour=MUTE)
        for number, chance in enumerate(pads):
            bar = (PANEL.left + _TRACK[0], top + _PADS + 22 * number - 1.5, _TRACK[1], 3)
            canvas.bar(bar, chance, HUMAN if chance == surest else mix(FAINT, HUMAN, 0.45))
        hud.draw_share(canvas, left, top + _WHY + 104 + lower, _WIDTH, share)

    def _draw_bar(self, canvas: Canvas, action: int) -> None:
        x, y = PANEL.left + _TRACK[0], PANEL.top + _FIRST + _ROW * action
        flown, good = action == self._flown, bool(self._feasible[action])
        value = float(self._bars[action])
        colour = NET if flown else mix(FAINT, NET, 0.45 if good else 0.12)
        canvas.bar((x, y - 1.5, _TRACK[1], 3), value, colour)
        if action == self._asked:
            canvas.dot((x + value * _TRACK[1], y), 4, HUMAN)

    def _paint_words(self, canvas: Canvas, pads: list[float]) -> None:
        """Draw the panel and the words on it that seldom change."""
        canvas.panel((0, 0, PANEL.width, PANEL.height + (PADS_HIGH if pads else 0)))
        canvas.text(texts.MIND_TITLE, (_LEFT, 34))
        for action, name in enumerate(ACTION_NAMES):
            flown, good = action == self._flown, bool(self._feasible[action])
            canvas.text(name, (_LEFT, _FIRST + _ROW * action + 4), size=SMALL, colour=INK if flown else MUTE,
                        alpha=1.0 if good or flown else 0.5)  # fmt: skip
        canvas.line((_LEFT, _WHY), (_LEFT + _WIDTH, _WHY), LINE)
        if pads:
            canvas.text(texts.INSIGHT_MEANT, (_LEFT, _PADS - 20), size=LABEL, colour=MUTE, weight="medium")
            for number, (name, chance) in enumerate(zip(self._names, pads, strict=True)):
                colour = INK if chance == max(pads) else MUTE
                canvas.text(name, (_LEFT, _PADS + 22 * number + 4), size=SMALL, colour=colour)


def _worth(values: Floats) -> Doubles:
    """Return values (6,) above the least, as shares of the most."""
    above = values - values.min()
    most = float(above.max())
    shares: Doubles = above / most if most > 0 and np.isfinite(most) else np.zeros(NUM_ACTIONS)
    return shares
