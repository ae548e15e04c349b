"""Environments of Gymnasium as one of ours. They are anybody's code: all that they return is checked as it comes in."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from ai.environment import SUCCESS, Bools, Doubles, ForeignEnvError, Ints, StepResult
from ai.files.reading import brief, shown

if TYPE_CHECKING:
    import gymnasium

GOING_ON: Final = 0
FAILED: Final = 2
_LARGEST: Final = float(np.finfo(np.float32).max)  # of what networks can take
T = TypeVar("T")


def asked(name: str, what: str, call: Callable[[], T]) -> T:
    """Return what an environment's own code returns; raises ForeignEnvError, in one line, for what it raises."""
    try:
        return call()
    except ForeignEnvError:
        raise
    except (Exception, SystemExit) as error:
        said = " ".join(str(error).split())
        raise ForeignEnvError(f"{name}: {what} raised {type(error).__name__}: {brief(said, 300)}") from error


class GymEnv:
    """Several environments of Gymnasium as one of ours (`ai.environment.Env`), stepped one by one.

    An observation is what the environment says it is: a Box laid flat, or a number of Discrete ones as one 1 among 0s.
    It stays in double precision, as its units may be any. An episode ends after `limit` steps of the environment at the
    latest, as by the clock. Whatever it cannot be that an environment returns raises ForeignEnvError.

    Attributes:
        returns, lengths: of each slot's episode so far: sum of rewards, and decisions.
        cut: whether it was this `limit` that ended it.

    """

    def __init__(
        self,
        name: str,
        make: Callable[[], gymnasium.Env[Any, Any]],
        num_envs: int,
        seeds: Ints,
        *,
        threshold: float | None = None,
        frame_skip: int = 1,
        limit: int,
    ) -> None:
        self.name, self.num_envs, self.threshold = name, num_envs, threshold
        self.frame_skip, self.limit = frame_skip, limit
        self.landings, self.stage = 0, 0
        self._envs: list[gymnasium.Env[Any, Any]] = []
        self._seeds: list[int | None] = seeds.tolist()
        try:
            for _ in range(num_envs):
                self._envs.append(make())
            self._space: Any = self._envs[0].observation_space
            self._first_action = int(getattr(self._envs[0].action_space, "start", 0))
            self._observation: NDArray[Any] = np.zeros((num_envs, features_of(self._space)))
        except BaseException:
            self.close()
            raise
        self.returns: Doubles = np.zeros(num_envs)
        self.lengths: Ints = np.zeros(num_envs, dtype=np.intp)
        self.outcome: Ints = np.zeros(num_envs, dtype=np.intp)
        self._steps: Ints = np.zeros(num_envs, dtype=np.intp)
        self._terminated, self._truncated, self.cut = np.zeros((3, num_envs), dtype=bool)

    def close(self) -> None:
        """Close every environment, even where another one's `close` fails."""
        for env in self._envs:
            with suppress(Exception, SystemExit):
                env.close()
        self._envs.clear()

    def reset(self, mask: Bools | None = None) -> NDArray[Any]:
        for slot in range(self.num_envs) if mask is None else np.flatnonzero(mask).tolist():
            # Seeded once; from then on each environment goes on with its own stream.
            seed, self._seeds[slot] = self._seeds[slot], None
            self.begin(slot, seed)
        return self.observe()

    def observe(self) -> NDArray[Any]:
        """Return every slot's observation (num_envs, features); raises ForeignEnvError where it is not finite."""
        wrong = ~(np.abs(self._observation) <= _LARGEST)
        if wrong.any():
            slot, place = (int(each[0]) for each in wrong.nonzero())
            seen = self._observation[slot, place]
            raise ForeignEnvError(
                f"{self.name}, environment {slot}: its observation is {seen:g} at place {place}, and no finite number"
            )
        return self._observation.copy()

    def begin(self, slot: int, seed: int | None) -> None:
        """Begin a new episode in one slot."""
        env = self._envs[slot]
        answer = asked(self.name, "reset", lambda: env.reset(seed=seed))
        if not isinstance(answer, tuple) or len(answer) != 2 or not isinstance(answer[1], dict):
            raise ForeignEnvError(
                f"{self.name}: reset returns {_kind(answer)}, and should return an observation and a dict of info, "
                "as Gymnasium has it since version 0.26"
            )
        self._take(slot, answer[0], "reset")
        for counted in (self.returns, self.lengths, self.outcome, self._steps):
            counted[slot] = 0
        for mark in (self._terminated, self._truncated, self.cut):
            mark[slot] = False

    def step(self, actions: Ints) -> StepResult:
        reward = np.zeros(self.num_envs, dtype=np.float32)
        for slot in np.flatnonzero(self.outcome == GOING_ON).tolist():
            reward[slot] = self._step_one(slot, int(actions[slot]))
        return StepResult(self.observe(), reward, self._terminated.copy(), self._truncated.copy(), self.outcome.copy())

    def _step_one(self, slot: int, action: int) -> float:
        env, total, ended = self._envs[slot], 0.0, False
        chosen = np.int64(action + self._first_action)
        for _ in range(self.frame_skip):
            answer: Any = asked(self.name, "step", lambda: env.step(chosen))
            if not isinstance(answer, tuple) or len(answer) != 5:
                raise ForeignEnvError(
                    f"{self.name}: step returns {_kind(answer)}, and should return observation, reward, terminated, "
                    "truncated and info, as Gymnasium has it since version 0.26"
                )
            observation, reward, terminated, truncated, _ = answer
            total += self._paid(slot, reward)
            self._steps[slot] += 1
            self.cut[slot] = not (terminated or truncated) and self._steps[slot] >= self.limit
            if ended := bool(terminated or truncated or self.cut[slot]):
                break
        self._take(slot, observation, "step")
        self._terminated[slot], self._truncated[slot] = bool(terminated), bool(truncated or self.cut[slot])
        self.returns[slot] += total
        self.lengths[slot] += 1
        if ended:
            succeeded = self.threshold is not None and self.returns[slot] >= self.threshold
            self.outcome[slot] = SUCCESS if succeeded else FAILED
            self.landings += int(succeeded)
        return total

    def _paid(self, slot: int, reward: Any) -> float:
        if type(reward) is float and abs(reward) <= _LARGEST:  # as nearly all are
            return reward
        number = np.asarray(reward)
        if number.size != 1 or number.dtype.kind not in "biuf":
            raise ForeignEnvError(f"{self.name}, environment {slot}: its reward is {_kind(reward)}, and no number")
        value = float(number.reshape(-1)[0])
        if not abs(value) <= _LARGEST:
            raise ForeignEnvError(f"{self.name}, environment {slot}: its reward is {value:g}, and no finite number")
        return value

    def _take(self, slot: int, observation: Any, what: str) -> None:
        """Take over what was observed in a slot."""
        try:
            seen = np.asarray(observation)
        except ValueError:  # lists of different lengths
            seen = np.asarray(None)
        row, discrete = self._observation[slot], hasattr(self._space, "n")
        fits = seen.dtype.kind in ("biu" if discrete else "biuf") and seen.shape == self._space.shape
        number = int(seen) - int(self._space.start) if fits and discrete else 0
        if not fits or not 0 <= number < len(row):
            raise ForeignEnvError(
                f"{self.name}, environment {slot}: {what} observes {_kind(observation)}, "
                f"and its space is {brief(self._space, 100)}"
            )
        if discrete:
            row[:] = 0.0
            row[number] = 1.0
            return
        row[:] = seen.reshape(-1)


def features_of(space: Any) -> int:
    """Return how many numbers a Box or a Discrete space becomes."""
    return int(space.n) if hasattr(space, "n") else int(np.prod(space.shape))


def _kind(value: Any) -> str:
    """Say in a few words what something is."""
    if isinstance(value, np.ndarray):
        return f"an array of {value.dtype} of shape {list(value.shape)}"
    if isinstance(value, tuple | list):
        return f"a {type(value).__name__} of {len(value)}"
    if isinstance(value, str | int | float | None):
        return shown(value)
    return f"a {type(value).__name__}"
