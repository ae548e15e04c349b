"""Chapter 5, what is it paid for: a small agent is trained on another pay, in a process of its own, and then flies."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from ai.environment import Ints
from ai.lander.environment import PARAMS, LanderEnv, Outcome
from ai.lander.rewards import RewardWeights
from ai.training.config import PRESETS, Config
from ai.training.history import Checkpoint
from ai.training.lander_session import LanderSession
from ai.training.messages import SwarmState
from engine import DT
from game.core import texts
from game.core.scene import Route
from game.core.worker import Worker, WorkerState
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, SMALL
from game.explain.figures import points
from game.scenes.learn.chapter import Chapter
from game.scenes.learn.pictures import draw_ground, draw_landers
from game.ui.context import Context
from game.ui.panel import Column
from game.world.camera import View

Flown = dict[str, float]
ENDS: Final = dict(zip(("landed", "crashed", "gone", "late"), list(Outcome)[1:], strict=True))
# What each pay is, by the key of its texts.
PAYS: Final = {
    "landing": RewardWeights(switch=-0.05),
    "aloft": RewardWeights(time=1.0, switch=-0.05),
    "haste": RewardWeights(time=-8.0, switch=-0.05, terminal=20.0),
    "end": RewardWeights(distance=0.0, speed=0.0, alignment=0.0, tilt=0.0, feet=0.0, switch=-0.05),
}
ASKED: Final = "aloft"  # the pay that the question is about
DECISIONS: Final = 24_000  # of single landers, after which it is looked at
SPAWN: Final = "near"
FLIGHTS: Final = 24
_SEED: Final = 7  # of the flights that are looked at
_SKIP, _PACE = 4, 2  # physics steps of a decision, and in an update
_SIZE, _METRES, _HEIGHT = 0.6, 26.0, 15.0  # of a lander's picture; metres that the picture shows at least
_BELOW: Final = 0.4  # metres below the ground


def config_of(pay: RewardWeights) -> Config:
    """Return the settings of a small, short run on that pay."""
    return PRESETS["modern"].changed(
        num_envs=64, spawn=SPAWN, gradient_steps=6, learning_starts=1000, epsilon_decisions=8000,
        schedule_decisions=DECISIONS, replay_size=100_000, reward_weights=pay,
    )  # fmt: skip


class Trial:
    """Flights of an agent without random actions, one physics step at a time."""

    def __init__(self, config: Config, checkpoint: Checkpoint) -> None:
        self.agent = checkpoint.agent(config)
        self.env = LanderEnv(FLIGHTS, _SEED, SPAWN, frame_skip=1)
        self.env.reset()
        self._steps = 0
        self._actions: Ints = np.zeros(FLIGHTS, np.intp)

    @property
    def over(self) -> bool:
        """Whether all flights have ended."""
        return bool((self.env.outcome != Outcome.FLYING).all())

    def step(self) -> None:
        """Fly one physics step; the agent decides in every fourth."""
        if self._steps % _SKIP == 0:
            self._actions = self.agent.act(self.env.observe(), held=self._actions)
        self._steps += 1
        self.env.fly(self._actions)

    def flown(self) -> Flown:
        """Return how the flights have ended so far: how many of each kind, and their mean time and fuel in seconds."""
        ends = {name: int((self.env.outcome == kind).sum()) for name, kind in ENDS.items()}
        return {**ends, "time": float(self.env.time.mean()), "fuel": float(self.env.fuel.mean())}


class PayChapter(Chapter):
    """A choice of pays; the run of the chosen one; and its flights.

    Attributes:
        pay: key of the chosen pay.
        decisions: how many the run has taken.
        trial: the flights after it; None before.
        results: by key of a pay, how its flights ended.
        note: why a run has failed; empty if none has.

    """

    key, door = "pay", Route("train")

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._worker: Worker | None = None
        self._runs, self.pay = 0, ASKED
        self.results: dict[str, Flown] = {}
        self._clear()

    def _clear(self) -> None:
        self.close()
        self.decisions, self.note = 0, ""
        self.trial: Trial | None = None
        self._swarm: SwarmState | None = None

    @property
    def judged(self) -> str:  # type: ignore[override]
        return texts.LEARN_PAY_NAMES[ASKED]

    def close(self) -> None:
        if self._worker:
            self._worker.close()
            self._worker = None

    @property
    def learning(self) -> bool:
        """Whether a run goes on."""
        return self._worker is not None

    def controls(self, column: Column) -> None:
        keys = list(PAYS)
        names = [texts.LEARN_PAY_NAMES[key] for key in keys]
        column.choice("", names, keys.index(self.pay), self.choose).by_arrows = True
        column.text(self._paid, size=SMALL, colour=HUMAN)
        column.button(texts.LEARN_PAY_STOP if self.learning else texts.LEARN_PAY_TRAIN, self.train)

    def _paid(self) -> str:
        """Return what the chosen pay is."""
        pay = PAYS[self.pay]
        return texts.LEARN_PAY_POINTS.format(
            second=points(pay.time / DT, 0),
            engine=points(pay.engine / DT, 1),
            landing=points(pay.terminal, 0),
            crash=points(-pay.terminal, 0),
            way=texts.LEARN_PAY_WAY[pay.distance > 0],
        )

    def choose(self, index: int) -> None:
        """Choose a pay, an index into `PAYS`."""
        self.pay, self.changed = list(PAYS)[index], True
        self._clear()

    def train(self) -> None:
        """Begin a run on the chosen pay, or end the one that goes on."""
        self.changed = True
        if self.learning:
            self.close()
            return
        self._clear()
        self.results.pop(self.pay, None)
        self.tried = bool(self.results)
        self._worker = Worker(LanderSession.live, config_of(PAYS[self.pay]), self._runs)
        self._runs += 1

    def update(self) -> None:
        if self._worker:
            self._hear(self._worker)
        elif self.trial and not self.trial.over:
            self._fly(self.trial)

    def _fly(self, trial: Trial) -> None:
        for _ in range(_PACE):
            trial.step()
        if trial.over:
            self.results[self.pay] = trial.flown()
            self.found()

    def _hear(self, worker: Worker) -> None:
        for message in worker.poll():
            if isinstance(message, SwarmState):
                self._swarm, self.decisions = message, message.decisions
            elif isinstance(message, Checkpoint) and message.decisions >= DECISIONS:
                self.trial = Trial(config_of(PAYS[self.pay]), message)
        if self.trial or worker.state in (WorkerState.FAILED, WorkerState.ENDED):
            self.note, self.changed = worker.problem, True
            self.close()

    def verdict(self) -> int | None:
        """Return what most flights did on the pay of the question: land, fly on, or crash; None before it was tried."""
        flown = self.results.get(ASKED)
        if flown is None:
            return None
        return int(np.argmax([flown["landed"], flown["late"] + flown["gone"], flown["crashed"]]))

    def why(self) -> str:
        return " ".join(
            texts.LEARN_PAY_WHY.format(name=texts.LEARN_PAY_NAMES[key], count=FLIGHTS, **flown)
            for key, flown in self.results.items()
        )

    def below(self, column: Column) -> None:
        column.bar(lambda: self.decisions / DECISIONS)
        column.text(self._state, size=SMALL)

    def _state(self) -> str:
        if self.trial:
            seconds = self.trial.env.time.max()
            return texts.LEARN_PAY_FLIGHTS.format(count=FLIGHTS, seconds=seconds, **self.trial.flown())
        if self.learning:
            return texts.LEARN_PAY_TRAINING.format(decisions=self.decisions, most=DECISIONS)
        return self.note or texts.LEARN_PAY_WAITING

    def draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        metres = max(_METRES, _HEIGHT * box.width / box.height)
        middle = PARAMS.ground - _BELOW + 0.5 * metres * box.height / box.width
        view = View.within(box, canvas.scale, (0.0, middle), box.width / metres)
        draw_ground(canvas, box, view)
        shown = self.trial.env if self.trial else self._swarm
        if shown is None:
            return
        poses = np.column_stack([shown.position, shown.angle]).astype(float)
        fired = shown.action if isinstance(shown, SwarmState) else shown.fired
        seen, burning = shown.outcome != Outcome.CRASHED, (fired >= 3) & (shown.outcome == Outcome.FLYING)
        with canvas.clipped(box):
            draw_landers(canvas, box, view, poses[seen], burning[seen], self.decisions, _SIZE)
