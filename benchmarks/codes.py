"""Length of flights' codes, and how many flights a second are read from codes and flown again.

    python -m benchmarks.codes [--flights 60] [--json]

Random starts are flown by the game's own network, by the scripted pilot (a decision every four steps, and in every
step), by clumsy hands: what the scripted pilot wanted a fifth of a second ago, each key by itself, in taps that last
0.05 to 0.25 seconds and begin at any step, and by sticks that follow what it wanted then, and tremble. Times are of the
processor, one thread.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
import json
import time
from pathlib import Path

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.flights.code import code_of, flight_of
from ai.flights.recording import Claim, Recording, SharedFlight, StickHolder, full, thrust
from ai.flights.verification import begun, earned, is_true, verified
from ai.lander.environment import Outcome
from ai.lander.pilots import Pilot, ScriptedPilot
from ai.lander.rules import ACTION_SHARES
from game.input.analogue import Stick, pushed

MODEL = Path(__file__).parents[1] / "models" / "lander" / "modern"
LATE = 12  # steps from what clumsy hands see to what they do
TAP = (3, 16)  # steps that a tap lasts, and the pause after it
SLOW, TREMOR = 0.12, 0.006  # shares of the way: of sticks in a step, and of hands that tremble
DECIDES = 12  # steps from one decision to the next
REPEATS = 10  # how often the flights are verified, to fill batches


class ClumsyHands:
    """Late hands that tap each key by itself for as long as they happen to."""

    def __init__(self, seed: int) -> None:
        self._rng, self._pilot = np.random.default_rng(seed), ScriptedPilot()
        self._seen: list[int] = [0] * LATE
        self._keys, self._left = [0, 0], [0, 0]

    def act(self, observation: np.ndarray, *, held: object = None) -> np.ndarray:  # noqa: ARG002
        """The action (1,) of the next step."""
        self._seen.append(int(self._pilot.act(observation)[0]))
        wanted = divmod(self._seen[-LATE], 3)
        for key in (0, 1):
            self._left[key] -= 1
            if self._left[key] < 0 and self._keys[key] != wanted[key]:
                self._keys[key] = wanted[key]
                self._left[key] = int(self._rng.integers(*TAP))
            elif self._left[key] < 0 and self._keys[key] and self._rng.random() < 0.2:
                self._keys[key], self._left[key] = 0, int(self._rng.integers(*TAP))  # lets go too early
        return np.array([3 * self._keys[0] + self._keys[1]])


class Sticks:
    """Late hands on a throttle and a stick, which take a while from one end to the other, and tremble a little."""

    def __init__(self, seed: int) -> None:
        self._rng, self._pilot = np.random.default_rng(seed), ScriptedPilot()
        self._seen: list[int] = [0] * LATE
        self._place, self._tremor, self._shares = np.zeros(2), np.zeros(2), full(0)

    def push(self, observation: np.ndarray) -> Stick:
        """Return the stick in the next step."""
        if len(self._seen) % DECIDES == 0:
            self._seen += [int(self._pilot.act(observation)[0])] * DECIDES
        else:
            self._seen.append(self._seen[-1])
        wanted = ACTION_SHARES[self._seen[len(self._seen) - 1 - LATE]]
        self._place += (wanted - self._place).clip(-SLOW, SLOW)
        self._tremor = 0.9 * self._tremor + self._rng.normal(0.0, TREMOR, 2)
        main, side = np.where(self._place == 0, 0, self._place + self._tremor).tolist()
        stick = pushed(main, side, self._shares)
        self._shares = stick.shares or full(stick.action)
        return stick


def fly(seed: int, pilot: Pilot | Sticks, every: int) -> SharedFlight:
    """Fly a random start to its end; the pilot decides every so many steps."""
    recording, stick = Recording(seed, "random"), Stick()
    env = begun(recording)
    while env.outcome[0] == Outcome.FLYING:
        if isinstance(pilot, Sticks):
            stick = pilot.push(env.observe())
        elif len(recording.actions) % every == 0:
            stick = Stick(int(pilot.act(env.observe(), held=np.array([stick.action]))[0]))
        env.fly(np.array([stick.action]), thrust(stick.shares))
        if stick.shares:
            recording.shares[len(recording.actions)] = stick.shares
        recording.actions.append(stick.action)
        recording.hands.append(StickHolder.HUMAN)
    real = earned(env, recording)
    return SharedFlight(recording, Claim(real.outcome, real.points, real.end))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--flights", type=int, default=60, help="flights of each pilot")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    agent = DeepQAgent.load(MODEL)
    pilots = {
        "network": (lambda _: agent, 4),
        "scripted": (lambda _: ScriptedPilot(), 4),
        "scripted, every step": (lambda _: ScriptedPilot(), 1),
        "clumsy hands": (ClumsyHands, 1),
        "sticks": (Sticks, 1),
    }
    told, codes = {}, []
    for name, (pilot, every) in pilots.items():
        flights = [fly(seed, pilot(seed), every) for seed in range(arguments.flights)]
        texts = [code_of(flight) for flight in flights]
        assert all(flight_of(text).recording == flight.recording for text, flight in zip(texts, flights, strict=True))
        codes += texts
        lengths = [len(text) for text in texts]
        actions = [np.array(flight.recording.actions) for flight in flights]
        told[name] = {
            "seconds": float(np.median([len(each) / 60 for each in actions])),
            "changes": float(np.median([np.count_nonzero(np.diff(each)) for each in actions])),
            "median": float(np.median(lengths)), "95 %": float(np.percentile(lengths, 95)), "most": max(lengths),
            "landed": float(np.mean([flight.claim.outcome == Outcome.LANDED for flight in flights])),
        }  # fmt: skip
    began = time.process_time()
    flights = [flight_of(code) for code in codes]
    read = time.process_time() - began
    many = flights * REPEATS
    began = time.process_time()
    right = sum(is_true(many[index], real) for index, real in verified(many))
    flown = time.process_time() - began
    assert right == len(many)
    told["verify"] = {"flights": len(many), "read a second": len(flights) / read, "flown a second": len(many) / flown}
    if arguments.json:
        print(json.dumps(told, indent=1))
        return
    print(f"{'pilot':22}{'seconds':>9}{'changes':>9}{'signs':>8}{'95 %':>8}{'most':>8}{'landed':>9}")
    for name in pilots:
        row = told[name]
        print(f"{name:22}{row['seconds']:9.1f}{row['changes']:9.0f}{row['median']:8.0f}{row['95 %']:8.0f}"
              f"{row['most']:8}{row['landed']:9.0%}")  # fmt: skip
    row = told["verify"]
    print(f"read {row['read a second']:.0f}, flown {row['flown a second']:.0f} flights a second ({len(many)} flights)")


if __name__ == "__main__":
    main()
