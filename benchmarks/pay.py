"""What small agents learn on each pay of the path's fifth chapter: how their flights end, over some seeds.

    python -m benchmarks.pay [--seeds 3]

The runs and the flights are those of the chapter (`game.scenes.learn.pay`).
"""

from __future__ import annotations

import argparse

from ai.training.history import Checkpoint
from ai.training.lander_session import LanderSession
from game.scenes.learn.pay import DECISIONS, ENDS, FLIGHTS, PAYS, Flown, Trial, config_of


def flown(pay: str, seed: int) -> Flown:
    """Train on a pay as the chapter does, and fly what has been learnt to its end."""
    config = config_of(PAYS[pay])
    for messages in LanderSession.live(config, seed):
        for message in messages:
            if isinstance(message, Checkpoint) and message.decisions >= DECISIONS:
                trial = Trial(config, message)
                while not trial.over:
                    trial.step()
                return trial.flown()
    raise AssertionError


def main() -> None:
    """Print a row for each pay and seed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=3)
    seeds = parser.parse_args().seeds
    print(f"{DECISIONS:,} decisions, then {FLIGHTS} flights: landed, crashed, flew away, no rest; seconds, engine")
    for pay in PAYS:
        for seed in range(seeds):
            each = flown(pay, seed)
            ends = " ".join(f"{each[name]:3}" for name in ENDS)
            print(f"{pay:8} {seed}  {ends}  {each['time']:5.1f} {each['fuel']:5.1f}", flush=True)


if __name__ == "__main__":
    main()
