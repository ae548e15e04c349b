"""Balance a pole with our agent: 500 points are the most. Needs Gymnasium (the extra `gym`)."""

from ai.training.config import gym_config
from ai.training.loop import run

DECISIONS = 60_000

if __name__ == "__main__":
    told = 0
    for progress in run(gym_config("CartPole-v1"), seed=1):
        if progress.decisions >= told:
            told += 4_000
            print(f"{progress.decisions:6} decisions: {progress.mean_return:5.1f} points, ε {progress.epsilon:.2f}")
        if progress.decisions >= DECISIONS:
            break
