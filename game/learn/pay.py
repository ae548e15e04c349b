"""Chapter 5, what is it paid for: a small agent is trained on another pay, in a process of its own, and then flies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pygame

from ai.environment import Bools, Doubles, Ints
from ai.lander.environment import PARAMS, LanderEnv, Outcome
from ai.lander.rewards import REWARDS, RewardWeights
from ai.training.config import Config
from ai.training.history import Checkpoint
from ai.training.lander_session import live
from ai.training.messages import SwarmState
from engine import DT
from game.core import texts
from game.core.scene import Route
from game.core.worker import Worker, WorkerState
from game.drawing.canvas import Canvas
from game.drawing.figures import write_figures
from game.drawing.tokens import FAINT, HUMAN, INK, MUTE, NET, SMALL
from game.flight.poses import Poses
from game.learn.chapter import STAGE, Chapter, Code
from game.learn.small_flight import inside, view_in
from game.ui.context import Context
from game.ui.widget import PointsManager, Widget
from game.ui.widgets import Choice, TextButton
from game.world.craft import draw_crowd, draw_fires
from game.world.landscape.pad import draw_pad

# What each pay is: a landing, haste, time aloft, fuel. By the key of its texts.
PAYS: Final = {
    "landing": RewardWeights(time=-0.4, switch=-0.05),
    "aloft": RewardWeights(time=1.0, switch=-0.05),
    "haste": RewardWeights(time=-8.0, switch=-0.05, terminal=20.0),
    "fuel": RewardWeights(time=0.0, switch=-0.05, engine=-4.0, terminal=30.0),
}
ASKED: Final = "aloft"  # the pay that the question is about
DECISIONS: Final = 24_000  # of single landers, after which it is looked at
SPAWN: Final = "near"
FLIGHTS: Final = 24
_SEED: Final = 7  # of the flights that are looked at
_SKIP: Final = 4  # physics steps of a decision
_PACE: Final = 2  # physics steps in an update
_SIZE: Final = 0.6
_METRES: Final = 26.0
_MIDDLE: Final = (0.0, 6.4)
_FOOT: Final = 60.0  # points below the flights, for what is told


def config_of(pay: RewardWeights) -> Config:
    """Return the settings of a small, short run on that pay."""
    return Config().changed(
        num_envs=64, spawn=SPAWN, gradient_steps=6, learning_starts=1000, epsilon_decisions=8000,
        schedule_decisions=DECISIONS, replay_size=100_000, reward_weights=pay,
    )  # fmt: skip


@dataclass(frozen=True)
class Flown:
    """How the flights after a training ended: numbers of each kind, and means over all of them, in seconds."""

    landed: int
    crashed: int
    gone: int
    late: int
    time: float
    fuel: float


class Trial:
    """Flights of an agent without random actions, one physics step at a time."""

    def __init__(self, config: Config, checkpoint: Checkpoint, flights: int = FLIGHTS) -> None:
        self.agent = checkpoint.agent(config)
        self.env = LanderEnv(flights, _SEED, SPAWN, frame_skip=1)
        self.env.reset()
        self.poses = Poses(self.env)
        self._steps = 0
        self._actions: Ints = np.zeros(flights, np.intp)

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
        self.poses.take()

    def flown(self) -> Flown:
        """Return how the flights have ended so far."""
        outcome = self.env.outcome
        landed, crashed, gone, late = (int((outcome == kind).sum()) for kind in list(Outcome)[1:])
        return Flown(landed, crashed, gone, late, float(self.env.time.mean()), float(self.env.fuel.mean()))


class PayChapter(Chapter):
    """A choice of four pays; the run of the chosen one; and its flights.

    Attributes:
        pay: key of the chosen pay.
        decisions: how many the run has taken.
        trial: the flights after it; None before.
        results: by key of a pay, how its flights ended.
        note: why a run has failed; empty if none has.

    """

    key = "pay"
    answer = 1
    door = Route("train")

    def __init__(self, context: Context, manager: PointsManager) -> None:
        super().__init__(context, manager)
        self._worker: Worker | None = None
        self._runs = 0
        self.restart()

    def restart(self) -> None:
        """Forget all runs."""
        self.close()
        self.pay, self.tried, self.note = ASKED, False, ""
        self.results: dict[str, Flown] = {}
        self._clear()

    def _clear(self) -> None:
        self.decisions = 0
        self.trial: Trial | None = None
        self._swarm: SwarmState | None = None
        self._checkpoint: Checkpoint | None = None

    def close(self) -> None:
        """End the run."""
        if self._worker:
            self._worker.close()
            self._worker = None

    @property
    def running(self) -> bool:
        """Whether a run goes on."""
        return self._worker is not None

    def widgets(self) -> list[Widget]:
        """Return the choice of the pay, and what begins or ends a run."""
        keys = list(PAYS)
        words = [texts.LEARN_PAY_NAMES[key] for key in keys]
        pay = Choice(self.manager, self.row(0), "", words, keys.index(self.pay), self._choose, gap=18)
        label = texts.LEARN_PAY_STOP if self.running else texts.LEARN_PAY_TRAIN
        return [pay, TextButton(self.manager, self.row(1), label, self.train)]

    def _choose(self, index: int) -> None:
        self.close()
        self.pay, self.changed = list(PAYS)[index], True
        self._clear()

    def train(self) -> None:
        """Begin a run on the chosen pay, or end the one that goes on."""
        self.changed = True
        if self.running:
            self.close()
            return
        self._clear()
        self.note = ""
        self._worker = Worker(live, config_of(PAYS[self.pay]), self._runs)
        self._runs += 1

    def update(self) -> None:
        """Hear the run; once it has learnt for long enough, fly what it has learnt."""
        if self._worker:
            self._hear(self._worker)
        elif self.trial and not self.trial.over:
            self._fly(self.trial)

    def _hear(self, worker: Worker) -> None:
        for message in worker.poll():
            if isinstance(message, SwarmState):
                self._swarm, self.decisions = message, message.decisions
            elif isinstance(message, Checkpoint):
                self._checkpoint = message
        if worker.state in (WorkerState.FAILED, WorkerState.ENDED):
            self.note = worker.problem
            self.close()
            self.changed = True
        elif self._checkpoint and self._checkpoint.decisions >= DECISIONS:
            self.close()
            self.trial = Trial(config_of(PAYS[self.pay]), self._checkpoint)
            self.changed = True

    def _fly(self, trial: Trial) -> None:
        for _ in range(_PACE):
            trial.step()
        if trial.over:
            self.results[self.pay] = trial.flown()
            self.tried = True

    # What it tells

    def why(self, guess: int | None) -> str:  # noqa: ARG002
        """Return how the flights of each run ended."""
        return " ".join(
            texts.LEARN_PAY_WHY.format(name=texts.LEARN_PAY_NAMES[key], count=FLIGHTS, **vars(self.results[key]))
            for key in PAYS
            if key in self.results
        )

    def code(self) -> Sequence[Code]:
        """Return the step of the environment that adds up the pay, with this pay's weights."""
        pay = PAYS[self.pay]
        weights = texts.LEARN_PAY_NOTE.format(time=pay.time, terminal=pay.terminal)
        return [Code(LanderEnv.step, "parts", {"parts": weights, np.add.accumulate: f"{len(REWARDS)}"})]

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the landers of the run, or those that fly what it has learnt, and below how far it is."""
        box = pygame.FRect(STAGE.left, STAGE.top, STAGE.width, STAGE.height - _FOOT)
        view = view_in(box, _MIDDLE, _METRES, canvas.scale)
        with inside(canvas, box):
            ((_, ground),) = view.points([(0.0, PARAMS.ground)]).tolist()
            canvas.line((box.left, ground), (box.right, ground), FAINT)
            draw_pad(canvas, view, (0.0, PARAMS.pad_top), PARAMS.pad_width, 0.0)
            poses, burning = self._shown(alpha)
            if len(poses):
                draw_fires(canvas, view, poses[burning], self.decisions, _SIZE)
                draw_crowd(canvas, view, poses, _SIZE)
        self._draw_state(canvas, box.bottom + 24)
        self._draw_pay(canvas)

    def _shown(self, alpha: float) -> tuple[Doubles, Bools]:
        """Return the poses (n, 3) to draw, and which of them fire their main engines (n,)."""
        if self.trial:
            env = self.trial.env
            seen = env.outcome != Outcome.CRASHED
            burning = (env.fired >= 3) & (env.outcome == Outcome.FLYING)
            return self.trial.poses.at(alpha)[seen], burning[seen]
        if self._swarm is None:
            return np.empty((0, 3)), np.empty(0, bool)
        swarm = self._swarm
        seen = swarm.outcome != Outcome.CRASHED
        poses = np.column_stack([swarm.position, swarm.angle]).astype(float)
        return poses[seen], (swarm.action[seen] >= 3) & (swarm.outcome[seen] == Outcome.FLYING)

    def _draw_state(self, canvas: Canvas, y: float) -> None:
        left = STAGE.left
        if self.trial:
            flown = self.trial.flown()
            told = texts.LEARN_PAY_FLIGHTS.format(count=FLIGHTS, seconds=self.trial.env.time.max(), **vars(flown))
            write_figures(canvas, told, (left, y), size=SMALL + 1, colour=INK)
        elif self.running:
            canvas.bar((left, y + 10, STAGE.width, 3), self.decisions / DECISIONS, NET)
            told = texts.LEARN_PAY_TRAINING.format(decisions=self.decisions, most=DECISIONS)
            write_figures(canvas, told, (left, y), size=SMALL + 1, colour=INK)
        else:
            canvas.text(self.note or texts.LEARN_PAY_WAITING, (left, y), size=SMALL + 1, colour=MUTE, room=STAGE.width)

    def _draw_pay(self, canvas: Canvas) -> None:
        """Write what the chosen pay is, above the flights."""
        pay, steps = PAYS[self.pay], 1 / DT
        told = texts.LEARN_PAY_POINTS.format(second=pay.time * steps, engine=pay.engine * steps, terminal=pay.terminal)
        write_figures(canvas, told, (STAGE.left + 4, STAGE.top + 14), size=SMALL, colour=HUMAN)
