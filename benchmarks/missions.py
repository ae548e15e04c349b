"""How the networks that come with the game fly the missions, and where they fail.

    python -m benchmarks.missions [--flights 20]

Each mission is flown from its own start, and from starts that differ from it a little: up to half a metre and 0.2 m/s,
3 degrees. Where it is as on the moon, `modern` flies, elsewhere `anywhere`, as in the game.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
from pathlib import Path

from ai.lander.environment import Cause, Outcome
from ai.lander.missions import MISSIONS
from tests.support.missions import fly, pilots

LANDERS = Path(__file__).parent.parent / "models" / "lander"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--flights", type=int, default=20)
    count = parser.parse_args().flights
    flyers = pilots(LANDERS)
    print("| mission | its own flight | fuel | time | medal | landed, of nearby starts | mostly fails by |")
    print("|---|---|---|---|---|---|---|")
    for mission in MISSIONS.values():
        outcome, cause, fuel, seconds = fly(flyers[mission.elsewhere], mission, count)
        landed = outcome == Outcome.LANDED
        how = [
            Cause(c).name if o == Outcome.CRASHED else Outcome(o).name
            for o, c in zip(outcome[~landed], cause[~landed], strict=True)
        ]
        worst = max(sorted(set(how)), key=how.count).lower() if how else "–"
        medal = mission.medal(float(fuel[0]), float(seconds[0])) if landed[0] else 0
        print(
            f"| {mission.name} | {Outcome(outcome[0]).name.lower()} | {fuel[0]:.1f} s | {seconds[0]:.1f} s | {medal} "
            f"| {landed.sum()} of {count} | {worst} |"
        )


if __name__ == "__main__":
    main()
