"""Head-up display (HUD): read-outs, bars and cards over the world; thin figures, one panel at most."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Final

import numpy as np
import pygame

from ai.lander.environment import Cause, LanderEnv, Outcome
from ai.lander.rules import tenths
from game.cockpit.ladder_mark import WIDTH as LADDER_WIDTH
from game.cockpit.ladder_mark import draw_ladder
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.paint_cache import PaintCache
from game.drawing.shapes import Shape
from game.drawing.tokens import (
    FAINT,
    FIGURE,
    HUMAN,
    INK,
    LABEL,
    LINE,
    MARGIN,
    MEDALS,
    MUTE,
    NET,
    NIGHT0,
    SMALL,
    TEXT,
    TITLE,
    VIEW_SIZE,
    Colour,
)
from game.flight import outcomes
from game.flight.outcomes import OutcomeCard, RivalOutcome
from game.ui.hints import Hint, HintRow

Lamp = tuple[Shape, Colour, float]  # shape, colour and strength of the glow

# Four columns on the left, two on the right: the landing pad stands in the middle.
COLUMNS: Final = (64.0, 186.0, 308.0, 430.0, 1002.0, 1124.0)
THRUST_COLUMN: Final = 880.0
_LABEL_LINE: Final = 663.0
_FIGURE_LINE: Final = 697.0
_BAR: Final = (92.0, 2.0)
_BAR_TOP: Final = 708.0
_TITLE_ROOM: Final = 400.0  # points for who flies
_SHADE, _SHADE_TOP = 0.6, 640.0  # greatest darkness behind the read-outs, and the row from which it begins
_CAPITAL: Final = 0.72  # height of a figure, in shares of its font size
# A readout's words are painted on a sheet: how far that reaches beyond them to the left and above, and its size.
_ASIDE, _ABOVE = 4.0, 16.0
_WORDS: Final = (180.0, 66.0)
_FIGURES: Final = PaintCache(64)
OPENING: Final = 122.0  # row of the words over a craft that waits
_LITTLE_TIME: Final = 5.0
_NAMED: Final = {Cause.HARD: 1, Cause.SLIDING: 2, Cause.TILTED: 3}  # which of the read-outs a crash is named by
_PLENTY_OF_TIME: Final = 120.0


@dataclass(frozen=True)
class Readout:
    """One read-out on the ground line: a figure with its label and bar.

    Attributes:
        fill: filled share of the bar, 0 to 1; None for no bar.
        limit: place of the limit's tick on the bar, 0 to 1; None for no limit.
        within: whether the value is within the limit; None without a limit.

    """

    label: str
    figure: str
    unit: str
    fill: float | None = None
    limit: float | None = None
    within: bool | None = None


def flight_readouts(env: LanderEnv, slot: int = 0) -> list[Readout]:
    """Return the read-outs that a pilot needs."""
    limits = env.limits
    across, up = env.velocity[slot].tolist()
    if env.conditions.moves:  # on a moving pad, the speed relative to the pad counts
        across -= float(env.pad_velocity[slot])
    tilt = float(env.tilt[slot])

    def against(label: str, figure: str, unit: str, value: float, limit: float) -> Readout:
        return Readout(label, figure, unit, abs(value) / (1.8 * limit), 1 / 1.8, abs(value) <= limit)

    descent = -up if abs(up) >= 0.05 else 0.0
    return [
        Readout(texts.ALTITUDE, f"{max(0.0, float(env.altitude[slot])):.1f}", "m"),
        against(texts.DESCENT, _signed(descent), "m/s", max(0.0, descent), limits.touch_speed),
        against(texts.DRIFT, f"{abs(across):.1f}", "m/s", across, limits.slide_speed),
        against(texts.TILT, f"{math.degrees(tilt):.0f}", "°", tilt, limits.touch_tilt),
        _fuel(env, slot),
        _time(env, slot),
    ]


def at_touch(readouts: list[Readout], env: LanderEnv) -> list[Readout]:
    """Return the last read-outs before a crash, with the figure marked that the reason of the crash names.

    On level ground it becomes what the foot felt, which a turning craft puts down faster than it falls itself.
    """
    cause = outcomes.cause_of(env)
    if env.outcome[0] != Outcome.CRASHED or cause not in _NAMED:
        return readouts
    speed, slide, tilt = env.impact[0].tolist()
    felt = {Cause.HARD: f"{speed:.1f}", Cause.SLIDING: f"{slide:.1f}", Cause.TILTED: f"{math.degrees(tilt):.0f}"}
    named, figure = _NAMED[cause], felt[cause]
    if outcomes.struck_side(env):  # neither down nor across, but the faster of the two is nearer to it
        named = max(_NAMED[Cause.HARD], _NAMED[Cause.SLIDING], key=lambda row: readouts[row].fill or 0.0)
        figure = readouts[named].figure
    marked = replace(readouts[named], figure=figure, within=False)
    return [*readouts[:named], marked, *readouts[named + 1 :]]


def _time(env: LanderEnv, slot: int) -> Readout:
    """Return the read-out of the time left, or, where there is plenty, of the time flown."""
    flown, limit = float(env.time[slot]), env.limits.time
    if limit > _PLENTY_OF_TIME:
        return Readout(texts.TIME_FLOWN, f"{flown:.0f}", "s")
    left = max(0.0, limit - flown)
    return Readout(texts.TIME_LEFT, f"{left:.0f}", "s", left / limit, within=None if left > _LITTLE_TIME else False)


def _fuel(env: LanderEnv, slot: int) -> Readout:
    """Return the read-out of the fuel used, or, where the tank is limited, of the fuel left."""
    burnt, tank = tenths(float(env.fuel[slot])), env.conditions.tank  # rounded as on the card and for medals
    if tank == math.inf:
        return Readout(texts.FUEL_USED, f"{burnt:.1f}", "s")
    left = max(0.0, tank - burnt)
    return Readout(texts.FUEL_LEFT, f"{left:.1f}", "s", left / tank, within=None if left > 0.2 * tank else False)


def thrust_readout(env: LanderEnv, slot: int = 0) -> Readout:
    """Return the read-out of the main engine's share of thrust, for those who fly with shares."""
    share = float(env.thrust[slot, 0])
    return Readout(texts.THRUST, f"{100 * share:.0f}", "%", share)


def draw_readouts(canvas: Canvas, readouts: Sequence[Readout], columns: Sequence[float] = COLUMNS) -> None:
    """Draw read-outs side by side: the bar shows the distance from the limit, a mark by the label on which side."""
    if canvas.whole is canvas:  # a page has no world behind it
        width, height = canvas.surface.get_width(), canvas.size[1] - canvas.px(_SHADE_TOP)
        corner = 0, canvas.surface.get_height() - height
        canvas.surface.blit(_shade((width, height)), corner, special_flags=pygame.BLEND_PREMULTIPLIED)
    for x, readout in zip(columns, readouts, strict=True):
        _draw_readout(column(canvas, x), x, readout)


def column(canvas: Canvas, x: float) -> Canvas:
    """Return the canvas for the read-out whose column begins at x: beside the nearer side, at the lower edge."""
    return canvas.at(-1 if x < VIEW_SIZE[0] / 2 else 1, 1)


def _draw_readout(canvas: Canvas, x: float, readout: Readout) -> None:
    colour = INK if readout.within is None else canvas.palette.good if readout.within else canvas.palette.warn
    shows = readout.label, readout.figure, readout.unit, readout.within
    box = (x - _ASIDE, _LABEL_LINE - _ABOVE, *_WORDS)
    _FIGURES.draw(canvas, box, shows, partial(_paint_readout, readout=readout, colour=colour))
    if readout.fill is not None:
        canvas.bar((x, _BAR_TOP, *_BAR), readout.fill, colour)
    if readout.limit is not None:
        canvas.line((x + readout.limit * _BAR[0], _BAR_TOP - 3), (x + readout.limit * _BAR[0], _BAR_TOP + 5), INK)


def readout_box(x: float) -> tuple[float, float, float, float]:
    """Return the area of the read-out whose column begins at x."""
    return x - _ASIDE, _LABEL_LINE - _ABOVE, _BAR[0] + 2 * _ASIDE, _BAR_TOP - _LABEL_LINE + _ABOVE + 8


@lru_cache(maxsize=2)
def _shade(size: tuple[int, int]) -> pygame.Surface:
    """Return the dark gradient behind the figures, premultiplied: over craters and wrecks they stay readable."""
    shade = pygame.Surface(size, pygame.SRCALPHA)
    shade.fill(NIGHT0)
    rise = np.linspace(0.0, 1.0, size[1]) ** 0.7
    pygame.surfarray.pixels_alpha(shade)[:] = np.round(255 * _SHADE * rise).astype(np.uint8)
    return shade.premul_alpha_ip()


def _paint_readout(canvas: Canvas, readout: Readout, colour: Colour) -> None:
    """Draw label, mark, figure and unit on a cached sheet, as most stay the same for some frames."""
    line = _FIGURE_LINE - _LABEL_LINE + _ABOVE
    label = canvas.text(readout.label, (_ASIDE, _ABOVE), size=LABEL, colour=MUTE, weight="medium")
    if readout.within is not None:
        draw_mark(canvas, (label.right + 9, _ABOVE - 4), readout.within)
    figure = canvas.text(readout.figure, (_ASIDE - 1, line), size=FIGURE, colour=colour, weight="light", tabular=True)
    gap, rise = (3, _CAPITAL * (FIGURE - SMALL)) if readout.unit == "°" else (6, 0.0)
    canvas.text(readout.unit, (figure.right + gap, line - rise), size=SMALL, colour=MUTE)


def draw_title(canvas: Canvas, text: str, lamp: Lamp, reach: float = 16.0) -> float:
    """Write who flies, with a lamp before it that shines to `reach` points; return the text's width in points."""
    shape, colour, glow = lamp
    canvas = canvas.at(0, -1)
    middle = VIEW_SIZE[0] / 2
    width = canvas.text(text, (middle + 9, 41), size=TEXT, align="centre", room=_TITLE_ROOM).width
    spot = lamp_spot(width)
    canvas.glow(spot, reach, colour, glow)
    canvas.marker(shape, spot, 8 if shape == "circle" else 11, colour)
    return width


def lamp_spot(width: float) -> Point:
    """Return the middle of the lamp before a title of that width."""
    return VIEW_SIZE[0] / 2 - width / 2 - 8, 36.0


def draw_hand(canvas: Canvas, text: str, colour: Colour) -> None:
    """Draw who flies at the top, over a line in their colour."""
    canvas = canvas.at(0, -1)
    half = max(90.0, draw_title(canvas, text, ("circle", colour, 0.8), reach=14.0) / 2 + 14)
    line = (VIEW_SIZE[0] / 2 - half, 54, 2 * half, 2)
    canvas.pill(line, FAINT, 0.5)
    canvas.pill(line, colour)


def draw_corner(canvas: Canvas, small: str, large: str, asked: str = "") -> None:
    """Draw the flight's name and its goal in the top left corner."""
    canvas = canvas.at(-1, -1)
    canvas.text(small, (MARGIN, 38), size=SMALL, colour=MUTE)
    canvas.text(large, (MARGIN, 58), size=TEXT)
    canvas.text(asked, (MARGIN, 78), size=SMALL, colour=MUTE)


def draw_centred_bars(
    canvas: Canvas, values: Sequence[float], top: float, left: float, width: float, step: float
) -> None:
    """Draw values from -1 to 1 as bars that grow from the middle, beside their names."""
    track = width - 96
    middle = left + 96 + track / 2
    for number, value in enumerate(values):
        y = top + step * number
        canvas.pill((left + 96, y - 1, track, 2), FAINT, 0.5)
        reach = min(max(value, -1.0), 1.0) * track / 2
        if abs(reach) >= 1:
            canvas.pill((min(middle, middle + reach), y - 1.5, abs(reach), 3), NET)
        canvas.line((middle, y - 4), (middle, y + 4), MUTE)


def draw_share(canvas: Canvas, left: float, top: float, width: float, human: float) -> None:
    """Draw the player's and the network's share of a flight; a share above zero never reads as 0 %."""
    you = round(100 * human) if human in (0.0, 1.0) else min(max(round(100 * human), 1), 99)
    if you:
        canvas.text(texts.SHARE_YOU.format(percent=you), (left, top), size=SMALL, colour=HUMAN, tabular=True)
    if you < 100:
        network = texts.SHARE_NETWORK.format(percent=100 - you)
        canvas.text(network, (left + width, top), size=SMALL, colour=NET, align="right", tabular=True)
    edge = width * human
    if human > 0:
        canvas.pill((left, top + 9, max(0.0, edge - 1), 3), HUMAN)
    if human < 1:
        canvas.pill((left + edge + 1, top + 9, width - edge - 1, 3), NET)


CARD: Final = pygame.Rect(400, 136, 480, 264)
_ADVICE_ROW: Final = 24
_NEXT_LAMP, _FLASH = 0.3, 0.22  # seconds from one lamp of a medal to the next, and in which its flash fades
_RING_PARTS: Final = 14
_RIVAL_ROWS: Final = 60
_GROWTH_ROW: Final = 22
_LADDER_ROW: Final = 30


def draw_card(
    canvas: Canvas,
    card: OutcomeCard,
    shown: float,
    advise: bool,
    rival: RivalOutcome | None = None,
    lit: float = math.inf,
) -> None:
    """Draw the outcome card, `shown` 0 to 1 of the way in, with its advice if wanted, and a rival's figures.

    The lamps of a medal light up one after another; they have done so for `lit` seconds.
    """
    drop = 10 * (1 - shown)
    left, top, width = card.left + 32, CARD.top - drop, CARD.width - 64
    lower = _lower(card, advise)
    canvas.panel((card.left, top, CARD.width, CARD.height + lower + _below(card, rival=rival is not None)))
    colour = canvas.palette.good if card.good else canvas.palette.warn
    colour = INK if card.intact else colour
    canvas.glow((left + 10, top + 44), 30, colour, 0.5 * shown)
    mark: Shape = "check" if card.good else "diamond" if card.intact else "cross"
    canvas.marker(mark, (left + 10, top + 44), 18, colour)
    canvas.text(card.title, (left + 34, top + 52), size=TITLE, colour=colour)
    score = canvas.text(card.score, (left + width, top + 52), size=TEXT, colour=HUMAN, align="right")
    _draw_medal(canvas, card, (score.left - 14, top + 47), lit)
    canvas.text(card.reason, (left, top + 86), size=TEXT, colour=INK, room=width)
    for row, (line, shade) in enumerate(_below_reason(card, advise)):
        canvas.text(line, (left, top + 110 + row * _ADVICE_ROW), size=SMALL, colour=shade, room=width)
    top += lower
    column = width / len(card.figures)
    for number, (label, value, unit) in enumerate(card.figures):
        x = left + number * column
        canvas.text(label, (x, top + 122), size=LABEL, colour=MUTE, weight="medium", room=column - 12)
        figure = canvas.text(value, (x, top + 149), size=TITLE, weight="light", tabular=True)
        canvas.text(unit, (figure.right + 4, top + 149), size=LABEL, colour=MUTE)
    if rival:
        _draw_rival(canvas, rival, [label for label, _, _ in card.figures], (left, top + 183), width)
        top += _RIVAL_ROWS
    draw_share(canvas, left, top + 188, width, card.human)
    if told := card.told:
        words = canvas.text(
            told,
            (left + width / 2 + 8, top + 188),
            size=SMALL,
            colour=MUTE,
            align="centre",
        )
        canvas.marker("diamond", (words.left - 10, top + 184), 8, NET)
        if card.saved is not None:
            canvas.explain((words.left - 16, top + 172, words.width + 20, 20), texts.EXPLAIN_CARD_SAVED)
    for line in card.growth:
        canvas.text(line, (left, top + 220), size=SMALL, colour=HUMAN, room=width)
        top += _GROWTH_ROW
    if card.rung is not None and card.climb:
        draw_ladder(canvas, left + 1, top + 223, card.rung)
        canvas.text(card.climb, (left + LADDER_WIDTH + 8, top + 223), size=SMALL, room=width - LADDER_WIDTH - 8)
        top += _LADDER_ROW
    canvas.line((left, top + 218), (left + width, top + 218), LINE)


def _draw_medal(canvas: Canvas, card: OutcomeCard, last: Point, lit: float) -> None:
    """Draw the lamps of a medal from right to left, each with a flash as it lights, or the ring of a shared landing."""
    x, y = last
    if card.ring:
        draw_ring(canvas, last)
    for lamp in range(card.medal):
        age, place = lit - _NEXT_LAMP * (lamp + 1), (x - 13 * lamp, y)
        if age < 0:
            canvas.dot(place, 4, FAINT)
            continue
        flash = math.exp(-age / _FLASH)
        canvas.glow(place, 14 + 30 * flash, MEDALS[card.medal], 0.35 + 1.6 * flash)
        canvas.dot(place, 4 + 3 * flash, MEDALS[card.medal])


def draw_ring(canvas: Canvas, place: Point) -> None:
    """Draw the ring of a landing together: half the person's, half the network's."""
    x, y = place
    for part in range(_RING_PARTS):
        angle = 2 * math.pi * (part + 0.5) / _RING_PARTS
        colour = HUMAN if math.cos(angle) < 0 else NET
        canvas.dot((x + 5 * math.cos(angle), y + 5 * math.sin(angle)), 1.3, colour)


def card_row(card: OutcomeCard, hints: list[Hint], shown: float, advise: bool, *, rival: bool) -> HintRow:
    """Return the row of hints at the foot of that card."""
    lower = _lower(card, advise) + _below(card, rival=rival)
    place = (card.left + 32, CARD.top - 10 * (1 - shown) + lower + 244)
    return HintRow(hints, place, room=CARD.width - 64)


def _below(card: OutcomeCard, *, rival: bool) -> int:
    """Return how many points of rows a card has more than the usual ones."""
    return _RIVAL_ROWS * rival + _GROWTH_ROW * len(card.growth) + _LADDER_ROW * bool(card.climb)


def _below_reason(card: OutcomeCard, advise: bool) -> list[tuple[str, Colour]]:
    """Return the lines below a card's reason: advice, if wanted, the guardian's, and the assists of the flight."""
    lines = (card.advice * advise, MUTE), (card.bare, NET), (card.assists, HUMAN)
    return [(words, colour) for words, colour in lines if words]


def _lower(card: OutcomeCard, advise: bool) -> int:
    """Return how many points lower those lines move all that is below them."""
    return _ADVICE_ROW * len(_below_reason(card, advise))


def _draw_rival(canvas: Canvas, rival: RivalOutcome, labels: Sequence[str], corner: Point, width: float) -> None:
    """Draw a rival's name, result and figures, in the columns of the player's own."""
    left, top = corner
    canvas.dot((left + 4, top - 4), 4, NET)
    canvas.text(rival.name, (left + 16, top), size=SMALL, colour=NET)
    canvas.text(rival.result, (left + width, top), size=SMALL, colour=INK, align="right")
    column = width / len(labels)
    for number, label in enumerate(labels):
        value, unit = rival.figures.get(label, ("–", ""))
        figure = canvas.text(value, (left + number * column, top + 25), size=TEXT, weight="light", tabular=True)
        canvas.text(unit, (figure.right + 4, top + 25), size=LABEL, colour=MUTE)


def draw_opening(
    canvas: Canvas, hints: Sequence[Hint], line: str, paths: Sequence[tuple[str, Colour]], top: float = OPENING
) -> None:
    """Draw the controls and the legend of the dotted paths in the middle, while the craft hangs and waits."""
    canvas = canvas.at(0, -1)
    middle = VIEW_SIZE[0] / 2
    canvas.text(line, (middle, top), size=TEXT, colour=MUTE, align="centre")
    row = HintRow(hints, (0, top + 28), size=TEXT)
    replace(row, position=(middle - row.width(canvas) / 2, top + 28)).draw(canvas)
    gap, dots = 32, 30
    x = middle - (sum(canvas.text_width(text, size=SMALL) + dots for text, _ in paths) + gap * (len(paths) - 1)) / 2
    for text, colour in paths:
        for number in range(3):
            canvas.dot((x + 4 + 8 * number, top + 52), 1.5, colour)
        x = canvas.text(text, (x + dots, top + 56), size=SMALL, colour=MUTE).right + gap


def draw_mark(canvas: Canvas, place: Point, within: bool) -> None:
    """Draw a dot for a value within its limit, a triangle for one beyond it."""
    if within:
        canvas.dot(place, 2.0, canvas.palette.good, 0.9)
    else:
        canvas.marker("triangle", place, 9, canvas.palette.warn)


def _signed(value: float) -> str:
    return f"{value:.1f}".replace("-", "−")
