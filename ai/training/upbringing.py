"""A network is brought up: two flights from one start are shown, again and again, and a person says which is better.

The choices teach a model of the person's taste (`ai.training.preferences`); it pays the agent, which goes on learning.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path
from typing import ClassVar, Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.environment import Bools, Doubles, Floats, Ints, StepResult
from ai.lander.environment import LanderEnv
from ai.lander.rules import FLYING, LANDED
from ai.lander.spawns import SPAWNS
from ai.training.config import PRESETS, Config
from ai.training.history import COLUMNS
from ai.training.loop import Progress, Training
from ai.training.messages import SwarmState
from ai.training.preferences import FIRST, NEITHER, SECOND, SUMS, PaidMemory, Paying, Taste
from ai.training.session import Session
from ai.training.state import State

UPBRINGING: Final = PRESETS["modern"].changed(schedule_decisions=240_000, replay_size=800_000, mirror=False)
BEFORE: Final = 30_000  # decisions that are flown at random before anything is asked
EACH: Final = 6_000  # decisions of learning that follow an answer
POOL: Final = 5  # answers after which other flights are flown to ask about
_STARTS, _COPIES = 12, 8  # of flights that are flown to ask about
_LANDINGS: Final = 4  # of these starts, where one that learns has landed
_DARING: Final = 0.5  # share of random actions in the most daring of them
_REMEMBERED: Final = 40  # landings of those that learn
_LONGEST: Final = 400  # decisions of any flight


class _Learner(DeepQAgent):
    """Agent whose memory is of sums. While it `rests`, it flies and learns nothing.

    Attributes:
        paying: what pays in its environment.
        flown: is called after every decision, before flights that ended begin anew.

    """

    paying: Paying
    flown: Callable[[], None]
    rests = False

    def learn(self) -> float | None:
        """Take gradient steps, once there is any pay to learn from."""
        return super().learn() if self.paying.points.any() and not self.rests else None

    def store(self, observation: Floats, actions: Ints, result: StepResult, success: Bools | None = None) -> None:
        if not self.rests:
            super().store(observation, actions, replace(result, reward=self.paying.latest), success)
        self.flown()


@dataclass(frozen=True, eq=False)
class Flight:
    """Flight to be looked at."""

    poses: Floats  # (decisions + 1, 3) x and y of the centre of mass, metres, and angle, radians
    actions: Ints  # (decisions,)
    outcome: int
    sums: Doubles  # (sums,)


Question = tuple[Flight, Flight]


class Upbringing(Training):
    """Training by a taste that is learned from answers meanwhile. It rests when it has learned enough from all of them.

    Whole flights from one start are compared: so nothing but how they are flown decides. They are flown by the network
    as it is, more or less daringly; some begin where one that learns has landed, by chance at first, and one of these
    does what that did. Or else landings would be rare for long, and a taste for them unknown.

    Attributes:
        taste: what the person is believed to like.
        question: two flights from one start; None before there are any.

    """

    env: LanderEnv
    agent: _Learner
    memory: PaidMemory

    def __init__(self, config: Config = UPBRINGING, seed: int = 0, *, since: int = 0) -> None:
        super().__init__(config, seed, evaluate_every=0, since=since)
        self._rng = np.random.default_rng([seed, since, 1])
        self.taste = Taste(self._rng)
        self.question: Question | None = None
        self.agent.paying = self.env.pay = Paying()
        self.agent.flown = self._watch
        self._learns_until = self.agent.decisions + BEFORE
        self._pool: list[list[Question]] = []  # for each start
        self._answered: list[Question] = []
        self._landings: deque[tuple[Doubles, Ints]] = deque(maxlen=_REMEMBERED)  # starts and actions
        self._starts: Doubles = np.zeros((self.env.num_envs, 6))
        self._actions: Ints = np.zeros((self.env.num_envs, _LONGEST), dtype=np.intp)

    def _new_learner(self, config: Config, rng: np.random.Generator) -> DeepQAgent:
        self.memory = PaidMemory(config.replay_size, self.task.num_features)
        return self._new_agent(_Learner, config, rng, replay=self.memory)

    @property
    def resting(self) -> bool:
        """Whether it has learned enough from all answers."""
        return self.agent.decisions >= self._learns_until

    def advance(self) -> Progress:
        """Let every lander take one decision, and learn from it; ask, if nothing is asked and enough is learned."""
        env, fresh = self.env, self.env.steps == 0
        self._starts[fresh] = np.column_stack([env.position, env.velocity, env.angle, env.angular_velocity])[fresh]
        self.agent.rests = self.resting
        progress: Progress = super().advance()
        if self.question is None and self.resting:
            self._pool = self._pool or self._scout()
            self._ask()
        return progress

    def _watch(self) -> None:
        """Remember what the learning landers do, for the sake of those that land."""
        env = self.env
        at = (env.steps - 1) // env.frame_skip
        self._actions[np.arange(env.num_envs), at] = env.actions
        for slot in np.flatnonzero(env.outcome == LANDED):
            self._landings.append((self._starts[slot].copy(), self._actions[slot, : at[slot] + 1].copy()))

    # Answers

    def answer(self, answer: int) -> None:
        """Take the answer to the question, and ask the next one; raises ValueError if there is none."""
        if self.question is None or answer not in (FIRST, SECOND, NEITHER):
            raise ValueError("there is no such question")
        first, second = self.question
        self._answered.append(self.question)
        self.taste.answer(first.sums - second.sums, answer)
        self._learns_until = max(self._learns_until, self.agent.decisions) + EACH
        if len(self.taste.answers) % POOL == 0:
            self._pool = []
        self._ask()

    def take_back(self) -> None:
        """Take the last answer back, and ask that question again; raises ValueError if there is none."""
        if not self._answered:
            raise ValueError("nothing has been answered since this began")
        self.taste.restore(self.taste.differences[:-1], self.taste.answers[:-1])
        self._pay()
        self.question = self._answered.pop()

    def _ask(self) -> None:
        """Pay by the taste as it is known now, and ask what would tell most of it; each start is asked about once."""
        self._pay()
        self.question = None
        pairs = [(start, *pair) for start, pairs in enumerate(self._pool) for pair in pairs]
        if pairs:
            told = self.taste.worth_asking(np.array([first.sums - second.sums for _, first, second in pairs]))
            start, first, second = pairs[int(told.argmax())]
            self.question = first, second
            del self._pool[start]

    def _pay(self) -> None:
        self.agent.paying.points = points = self.taste.pay
        self.memory.pay(points)

    def ready(self) -> Question:
        """Learn from all answers, and return the question."""
        while self.question is None or not self.resting:
            self.advance()
        return self.question

    def _scout(self) -> list[list[Question]]:
        """Fly from a few starts, several times from each; return pairs for each start."""
        rng, count = self._rng, _STARTS * _COPIES
        known = [self._landings[number] for number in rng.permutation(len(self._landings))[:_LANDINGS]]
        starts = [start for start, _ in known]
        starts += [SPAWNS["mixed"](rng) for _ in range(_STARTS - len(starts))]
        paying = Paying()
        env = LanderEnv(count, 0, "random", self.config.frame_skip, pay=paying)
        env.place(np.ones(count, dtype=bool), np.repeat(starts, _COPIES, axis=0))
        daring = np.tile(np.linspace(0.0, _DARING, _COPIES), _STARTS)
        done: Ints = np.full((count, _LONGEST), -1)
        for number, (_, actions) in enumerate(known):
            done[(number + 1) * _COPIES - 1, : len(actions)] = actions
        poses, sums = [_poses(env)], np.zeros((count, len(SUMS)))
        taken: list[Ints] = []
        observation, held = env.observe(), env.actions
        while (env.outcome == FLYING).any():
            again = done[:, len(taken)]
            held = np.where(again < 0, self.agent.act(observation, daring, held), again)
            observation = env.step(held).observation
            sums += paying.latest
            poses.append(_poses(env))
            taken.append(held)
        lengths = -(-env.steps // env.frame_skip)
        flights = [
            Flight(np.stack(poses)[: length + 1, slot], np.stack(taken)[:length, slot], outcome, sums[slot])
            for slot, (length, outcome) in enumerate(zip(lengths.tolist(), env.outcome.tolist(), strict=True))
        ]
        groups = (flights[first : first + _COPIES] for first in range(0, count, _COPIES))
        return [list(combinations(group, 2)) for group in groups]

    # On disk: answers and networks, and no memory, which is soon full again

    def state(self) -> State:
        taste = self.taste
        return {
            "rng": self.agent.rng.bit_generator.state, "differences": taste.differences, "answers": taste.answers
        }  # fmt: skip

    def load_state(self, state: State) -> None:
        super().load_state(state)
        differences, answers = np.asarray(state["differences"], float), np.asarray(state["answers"])
        if differences.shape != (len(answers), len(SUMS)) or not np.isin(answers, (FIRST, SECOND, NEITHER)).all():
            raise ValueError("the answers are of another kind")
        self.taste.restore(differences, answers.astype(np.intp))
        self._pay()
        self._learns_until = self.agent.decisions + BEFORE


def _poses(env: LanderEnv) -> Floats:
    return np.column_stack([env.position, env.angle]).astype(np.float32)


@dataclass(frozen=True, eq=False)
class Asked:
    """A question, and the taste as it is known now; sent whenever one of them is another."""

    newest_only: ClassVar = True

    answers: int  # so far
    question: Question | None
    liking: Doubles  # (sums,) mean weight of each


class TasteSession(Session[Upbringing]):
    """Session of an upbringing: what is asked, what is liked, and the landers. It is kept after every answer."""

    kind, columns = Upbringing, COLUMNS

    def __init__(self, training: Upbringing, keep: Path | None, source: Path | None) -> None:
        super().__init__(training, keep, source)
        self._asked: Question | None = None
        training.on_step = self._on_step

    def show(self) -> None:
        training = self.training
        self._asked = training.question
        liking = training.taste.weights.mean(axis=0)
        self.messages.append(Asked(len(training.taste.answers), self._asked, liking))

    def tell(self, progress: Progress) -> None:  # noqa: ARG002 - what is shown is no curve
        if self.training.question is not self._asked:
            self.show()

    def _on_step(self, result: StepResult) -> None:  # noqa: ARG002
        self.messages.append(SwarmState.of(self.training.env, self.training.agent.decisions))

    def _choose(self, answers: int, answer: int) -> None:
        """Take the answer to the question after so many; one to another question is not meant."""
        if answers == len(self.training.taste.answers):
            self.training.answer(answer)
            self._changed()

    def _take_back(self) -> None:
        self.training.take_back()
        self._changed()

    def _changed(self) -> None:
        self.show()
        if self.keep is not None:
            self.keeper.move_to(self.keep)

    commands = Session.commands | {"choose": _choose, "take_back": _take_back}
