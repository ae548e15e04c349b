"""How honest is the estimate of how often a pilot would land alone? Simulated pilots whose true share is known say.

    python -m benchmarks.becoming               coverage of the 80 % interval, by number of flights
    python -m benchmarks.becoming --calibrate   the constants of ai/copilot/alone.py, for the shipped network

Pilots are hands with faults drawn at random (`ai.copilot.hands.any_hands`) that each keeps for life. As most of them
land never or always, more are drawn than are needed, and as many kept of every skill as there are.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.copilot.alone import ASSISTS, CALM_SECONDS, LandingAlone
from ai.copilot.copilot import CoPilot, Mode
from ai.copilot.hands import ClumsyHands, Faults, OneOrOther, any_hands
from ai.environment import Bools, Doubles, Ints
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.pilots import Gains, ScriptedPilot
from ai.training.statistics import wilson

MODEL: Final = Path("models/lander/modern")
_SECONDS: Final = 1 / 15  # of a decision
_SCREENED: Final = 5  # pilots drawn for each one kept
_SCREENING: Final = 8  # flights of each of them
_CHECK_EVERY: Final = 5
_FLIGHTS: Final = (5, 10, 25)


def chosen(pilot: Any, pilots: Ints) -> ClumsyHands:
    """Return hands for slots (n,) in which the drawn pilots of those numbers fly."""
    either, rest = pilot.pilot, pilot.pilot.other
    gains = Gains(*(values[pilots] for values in vars(rest.other.gains).values()))
    others = OneOrOther(rest.first[pilots], rest.pilot, ScriptedPilot(gains))
    wishes = OneOrOther(either.first[pilots], either.pilot, others)
    faults = Faults(**{name: getattr(pilot, name)[pilots] for name in vars(Faults())})
    return ClumsyHands(wishes, len(pilots), pilot.rng, faults)


def fly(hands: ClumsyHands, seed: int, copilot: CoPilot | None = None) -> tuple[Bools, Doubles]:
    """Fly once in every slot; return whether each landed, and for how many seconds a guardian changed it, (n,)."""
    env = LanderEnv(hands.slots, seed)
    env.reset()
    changed = np.zeros(hands.slots)
    while (flying := env.outcome == Outcome.FLYING).any():
        action = hands.act(env.observe(), held=env.actions)
        if copilot:
            decision = copilot.decide(env.observe_pads(), action, env=env)
            changed += _SECONDS * (flying & decision.overridden)
            action = decision.action
        env.fly(action)
    return env.outcome == Outcome.LANDED, changed


class Population:
    """Pilots of every skill, each of whom can fly many times."""

    def __init__(self, pilots: int, seed: int, agent: DeepQAgent) -> None:
        self._agent, self._seed = agent, seed
        drawn = _SCREENED * pilots
        self._drawn = any_hands(drawn, np.random.default_rng(seed), agent)
        self._kept = np.arange(drawn)
        times = self.alone(_SCREENING).sum(axis=1)
        rank = np.zeros(drawn)  # among those that landed as often
        for landed in range(_SCREENING + 1):
            same = times == landed
            rank[same] = np.arange(same.sum())
        self._kept = np.argsort(rank, kind="stable")[:pilots]

    def alone(self, flights: int) -> Bools:
        """Return whether each pilot's flights alone landed, (pilots, flights)."""
        return self._fly(flights, None)[0]

    def helped(self, flights: int, assist: float) -> tuple[Bools, Doubles]:
        """Return whether flights with a guardian landed, and the seconds it changed, (pilots, flights) each."""
        return self._fly(flights, CoPilot(self._agent, assist, Mode.GUARDIAN))

    def _fly(self, flights: int, copilot: CoPilot | None) -> tuple[Bools, Doubles]:
        self._seed += 1
        landed, changed = fly(chosen(self._drawn, np.repeat(self._kept, flights)), self._seed, copilot)
        shape = (len(self._kept), flights)
        return landed.reshape(shape), changed.reshape(shape)


def calibrate(population: Population, flights: int) -> None:
    """Print the constants of `ai/copilot/alone.py`: the likeliest ones, given flights alone and with a guardian."""
    alone = population.alone(2 * flights)
    found = []
    for assist in ASSISTS:
        landed, changed = population.helped(flights, assist)
        found.append(likeliest(alone, landed & (changed <= CALM_SECONDS)))
    for name, values in zip(("BASE", "SLOPE", "SPREAD"), np.transpose(found).round(2).tolist(), strict=True):
        print(f"{name}: Final = {tuple(values)}")


def likeliest(alone: Bools, calm: Bools) -> Doubles:
    """Return base, slope and spread under which these flights (pilots, flights) are likeliest, by a pattern search."""
    odds = np.linspace(-5.0, 5.0, 41)
    nodes, weights = np.polynomial.hermite_e.hermegauss(9)
    skill = _log_chance(alone, odds[None, :])

    def fit(constants: Doubles) -> float:
        base, slope, spread = constants
        each = _log_chance(calm, (base + slope * odds[:, None] + spread * nodes).ravel()[None, :])
        joint = np.exp(each.reshape(len(calm), len(odds), -1) + skill[:, :, None]) @ weights
        return float(np.log(joint.sum(axis=1)).sum())

    best, step = np.array([0.0, 0.7, 1.0]), 0.8
    while step > 0.01:
        moves = [best + step * sign * axis for axis in np.eye(3) for sign in (-1.0, 1.0)]
        better = max(moves, key=fit)
        best, step = (better, step) if fit(better) > fit(best) else (best, step / 2)
    return np.array([best[0], best[1], abs(best[2])])


def _log_chance(happened: Bools, odds: Doubles) -> Doubles:
    """Return the log-likelihood (pilots, k) of events (pilots, flights) for log-odds (1, k)."""
    times, most = happened.sum(axis=1)[:, None], happened.shape[1]
    likelihood: Doubles = times * odds - most * np.logaddexp(0.0, odds)
    return likelihood


def coverage(population: Population, truth: int, assist: float) -> None:
    """Print how often the truth lies within the interval after some flights, alone, and mostly helped."""
    share = population.alone(truth).mean(axis=1)
    alone = population.alone(max(_FLIGHTS))
    landed, changed = population.helped(max(_FLIGHTS), assist)
    print(f"{truth} flights alone for each pilot's true share")
    report(share, alone, landed, changed, assist)


def report(share: Doubles, alone: Bools, landed: Bools, changed: Doubles, assist: float) -> None:
    """Print the same, given true shares (pilots,) and what flights alone and helped have shown (pilots, flights)."""
    print(f"{len(share)} pilots, who land {share.mean():.0%} alone")
    print("flights              | truth in the 80 % interval | its width | estimate off by")
    for every, told in ((1, "alone"), (_CHECK_EVERY, f"guardian {assist:.0%}, 1 in 5 alone")):
        for flights in _FLIGHTS:
            estimates = []
            for pilot in range(len(share)):
                belief = LandingAlone()
                for flight in range(flights):
                    if flight % every == every - 1:
                        belief.add_alone(landed=bool(alone[pilot, flight]))
                    else:
                        belief.add_helped(
                            landed=bool(landed[pilot, flight]), changed=float(changed[pilot, flight]), assist=assist
                        )
                estimates.append(belief.estimate)
            within = np.mean([each.low <= true <= each.high for each, true in zip(estimates, share, strict=True)])
            low, high = wilson(float(within), len(share))
            width = np.mean([each.high - each.low for each in estimates])
            off = np.mean([abs(each.mean - true) for each, true in zip(estimates, share, strict=True)])
            print(f"{flights:3} {told:28} {within:.0%} ({low:.0%} to {high:.0%})  {width:.2f}  {off:.2f}")


def main() -> None:
    """Measure, or calibrate."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--calibrate", action="store_true", help="print the constants for the shipped network")
    parser.add_argument("--pilots", type=int, default=100)
    parser.add_argument("--truth", type=int, default=100, help="flights alone that each pilot's true share is from")
    parser.add_argument("--assist", type=float, default=0.4)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    population = Population(arguments.pilots, arguments.seed, DeepQAgent.load(MODEL))
    if arguments.calibrate:
        calibrate(population, flights=16)
    else:
        coverage(population, arguments.truth, arguments.assist)


if __name__ == "__main__":
    main()
