# mypy: ignore-errors
"""Environments as other people write them: endless, crashing, in odd units; registered as odd/NAME-v0."""

import gymnasium
import numpy as np
from gymnasium.spaces import Box, Dict, Discrete, MultiBinary, Text, Tuple

OPEN: list["Odd"] = []  # those that were made and not closed


class Odd(gymnasium.Env):
    """A sound environment: which of two buttons is right is what it shows. Others change one thing about it."""

    observation_space = Box(-np.inf, np.inf, (2,), np.float64)
    action_space = Discrete(2)
    offset, unit, length = 0.0, 1.0, 20
    most_open = 0

    def __init__(self, length=None, render_mode=None):
        self.length, self.at, self.right = length or self.length, 0, 0
        OPEN.append(self)
        Odd.most_open = max(Odd.most_open, len(OPEN))

    def close(self):
        OPEN.remove(self)

    def seen(self):
        return self.offset + self.unit * np.array([2.0 * self.right - 1.0, 0.3])

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.at, self.right = 0, int(self.np_random.integers(2))
        return self.seen(), {}

    def pay(self, action):
        return float(action == self.right)

    def step(self, action):
        paid, self.at = self.pay(action), self.at + 1
        self.right = int(self.np_random.integers(2))
        return self.seen(), paid, self.at >= self.length, False, {}


class Endless(Odd):
    length = 10**9


class Far(Odd):
    offset = 1e8


class Tiny(Odd):
    unit = 1e-8


class Huge(Odd):
    unit = 1e20


class FarAndFine(Odd):
    offset, unit = 1e8, 1e-3


class Typed(Odd):
    """Takes np.int64 alone."""

    def pay(self, action):
        assert type(action) is np.int64
        return super().pay(action)


class PaysArrays(Odd):
    def pay(self, action):
        return np.array([super().pay(action)])


class PaysOneNumber(Odd):
    def pay(self, action):
        return np.float64(super().pay(action))


class StartsAtOne(Odd):
    action_space = Discrete(2, start=1)

    def pay(self, action):
        assert action in (1, 2)
        return float(action - 1 == self.right)


class Numbered(Odd):
    observation_space = Discrete(4, start=-1)

    def seen(self):
        return self.right - 1


class Numpys(Numbered):
    def seen(self):
        return np.int64(self.right - 1)


class Pixels(Odd):
    observation_space = Box(0, 255, (2, 3), np.uint8)

    def seen(self):
        return np.full((2, 3), 200 * self.right, np.uint8)


class Lists(Odd):
    def seen(self):
        return [2.0 * self.right - 1.0, 0.3]


class Scalar(Odd):
    observation_space = Box(-1, 1, ())

    def seen(self):
        return 2.0 * self.right - 1.0


class CannotClose(Odd):
    def close(self):
        super().close()
        raise RuntimeError("no")


class Truncates(Odd):
    def step(self, action):
        seen, paid, terminated, _, info = super().step(action)
        return seen, paid, np.bool_(False), np.bool_(terminated), info


class Later(Odd):
    """Goes wrong in its 30th step."""

    count = 0

    def step(self, action):
        answer = super().step(action)
        self.count += 1
        return self.wrong(*answer) if self.count == 30 else answer


class NanSeen(Later):
    def wrong(self, seen, *rest):
        return np.array([0.0, np.nan]), *rest


class InfiniteSeen(Later):
    def wrong(self, seen, *rest):
        return np.array([np.inf, 0.0]), *rest


class TooLargeSeen(Later):
    def wrong(self, seen, *rest):
        return np.array([1e300, 0.0]), *rest


class NanPaid(Later):
    def wrong(self, seen, paid, *rest):
        return seen, np.nan, *rest


class InfinitePaid(Later):
    def wrong(self, seen, paid, *rest):
        return seen, -np.inf, *rest


class NonePaid(Later):
    def wrong(self, seen, paid, *rest):
        return seen, None, *rest


class TextPaid(Later):
    def wrong(self, seen, paid, *rest):
        return seen, "much", *rest


class TwoPaid(Later):
    def wrong(self, seen, paid, *rest):
        return seen, [1.0, 2.0], *rest


class LoseConnection(Later):
    def wrong(self, *rest):
        raise ConnectionResetError(104, "Connection reset by peer")


class NoNumberOne(Later):
    def wrong(self, *rest):
        raise KeyError("x")


class Exits(Later):
    def wrong(self, *rest):
        raise SystemExit(3)


class OldStep(Later):
    def wrong(self, seen, paid, terminated, *rest):
        return seen, paid, terminated, {}


class NothingBack(Later):
    def wrong(self, *rest):
        return None


class Shorter(Later):
    def wrong(self, seen, *rest):
        return seen[:1], *rest


class OneNumber(Later):
    def wrong(self, seen, *rest):
        return np.float64(0.5), *rest


class Words(Later):
    def wrong(self, seen, *rest):
        return "left", *rest


class Objects(Later):
    def wrong(self, seen, *rest):
        return np.array([None, 1.0]), *rest


class Ragged(Later):
    def wrong(self, seen, *rest):
        return [[1.0], [2.0, 3.0]], *rest


class OutOfSpace(Numbered, Later):
    def wrong(self, seen, *rest):
        return 7, *rest


class HalfNumber(Numbered, Later):
    def wrong(self, seen, *rest):
        return 0.5, *rest


class OldReset(Odd):
    def reset(self, *, seed=None, options=None):
        return super().reset(seed=seed)[0]


class WrongShape(Odd):
    def reset(self, *, seed=None, options=None):
        return np.zeros(3), super().reset(seed=seed)[1]


class OneForTwo(Odd):
    def reset(self, *, seed=None, options=None):
        return np.zeros(1), super().reset(seed=seed)[1]


class TextSeen(Odd):
    def reset(self, *, seed=None, options=None):
        return "a door", super().reset(seed=seed)[1]


class ResetCrashes(Odd):
    def reset(self, *, seed=None, options=None):
        raise ZeroDivisionError("division\nby zero")


class NoSeed(Odd):
    def reset(self):
        return self.seen(), {}


class CannotBeMade(Odd):
    def __init__(self, **_):
        raise FileNotFoundError(2, "No such file", "rom.bin")


class Dicts(Odd):
    observation_space = Dict({"a": Discrete(2)})


class Tuples(Odd):
    observation_space = Tuple((Discrete(2), Discrete(2)))


class Texts(Odd):
    observation_space = Text(5)


class Pushes(Odd):
    action_space = Box(-1, 1, (1,))


class Switches(Odd):
    action_space = MultiBinary(2)


class Vast(Odd):
    observation_space = Box(0, 255, (2000, 2000), np.uint8)


for kind in [Odd, *Odd.__subclasses__(), *Later.__subclasses__(), *Numbered.__subclasses__()]:
    name = f"odd/{kind.__name__}-v0"
    if name not in gymnasium.registry:
        gymnasium.register(name, entry_point=kind)
