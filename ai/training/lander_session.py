"""Session of landers: what is seen of them, checkpoints to go back to, lessons."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Final

import numpy as np

from ai.environment import StepResult
from ai.lander.environment import LanderEnv, Outcome
from ai.training.explanations import Explanations
from ai.training.history import COLUMNS, REVERTED, Checkpoint, Validation
from ai.training.loop import Progress, Training
from ai.training.messages import DIVERGED, FirstLanding, NetworkState, SwarmState
from ai.training.session import Session
from ai.training.tasks import Score

POINT_DECISIONS: Final = 256  # at least so many between two points
NETWORK_SECONDS: Final = 0.25
CAREFUL: Final = 0  # the lander with the fewest random actions; the last one has the most (Config.epsilon_spread)


class LanderSession(Session[Training]):
    """Session of landers. They never stand still for a validation: that is flown bit by bit."""

    kind, columns = Training, COLUMNS

    def __init__(self, training: Training, keep: Path | None, source: Path | None) -> None:
        if not isinstance(training.env, LanderEnv):
            raise ValueError(f"only landers can be looked into, not {training.config.env}")
        super().__init__(training, keep, source)
        self.env = training.env
        self.history.reward_scale = training.config.reward_scale
        training.on_step = self._on_step
        training.validation_pace = 1 + self.env.num_envs // 256
        self._explanations = Explanations(training)
        self._swarm_state = SwarmState.of(self.env, training.agent.decisions)
        self._shown_at = 0.0
        self._point_at = 0
        self._checkpoint_at = training.agent.decisions + self._checkpoint_every
        self._new = not training.agent.decisions  # it has not landed yet
        if not self.history.checkpoints:
            self.record(self._checkpoint(0.0))

    @property
    def _checkpoint_every(self) -> int:
        """Decisions between checkpoints: sparser as the run gets longer, so that the first hours keep them all."""
        return max(40 * self.env.num_envs, 2_500, self.training.agent.decisions // 50)

    def show(self) -> None:
        agent, training = self.training.agent, self.training
        values, gradients, sensed = agent.online.values, agent.online.gradients, training.observation[CAREFUL]
        network = NetworkState(values.copy(), gradients.copy(), sensed.copy(), agent.decisions)
        self.messages += (self._swarm_state, network)

    def tell(self, progress: Progress) -> None:
        now = self.training.clock()
        self._tell_validation(self.training.evaluation)
        if now >= self._shown_at:
            self._shown_at = now + NETWORK_SECONDS
            self.show()
        else:
            self.messages.append(self._swarm_state)
        if progress.decisions >= self._point_at:
            self._point_at = progress.decisions + POINT_DECISIONS
            self.record(progress)
        if progress.decisions >= self._checkpoint_at:
            self.record(self._checkpoint(self.training.statistics.shares[Outcome.LANDED - 1]))
            self._checkpoint_at = progress.decisions + self._checkpoint_every

    def _tell_validation(self, score: Score | None) -> None:
        """Tell what came of validation flights, if they are over."""
        training = self.training
        if score is not None and score.success is not None:
            best, evaluated = score is training.best, training.evaluated or 0
            self.record(Validation(evaluated, score.success, score.mean_return, best, training.seconds))

    def go_back(self) -> None:
        """Restore the networks from the last checkpoint, when training has diverged since."""
        self.training.diverged = True
        self.history.checkpoints[-1].restore(self.training.agent)

    def _on_step(self, result: StepResult) -> None:
        self._swarm_state = SwarmState.of(self.env, self.training.agent.decisions)
        self._explanations.follow(self.env.actions, result)
        landed = np.flatnonzero(result.outcome == Outcome.LANDED)
        if self._new and len(landed) and self.training.agent.ready:
            self._new = False
            with suppress(ValueError):  # a network too large to be explained
                self.messages.append(FirstLanding(self._explanations.explain(int(landed[0]))))

    def _checkpoint(self, success: float) -> Checkpoint:
        agent = self.training.agent
        values = agent.network.values.copy()
        if not np.isfinite(values).all():
            raise FloatingPointError(
                f"the network was {DIVERGED} after learning step {agent.gradient_steps}; "
                f"most likely the learning rate of {agent.optimizer.learning_rate:g} is too high"
            )
        normalizer = agent.normalizer.to_json() if agent.normalizer else None
        return Checkpoint(self.training.seconds, agent.decisions, success, values, normalizer)

    # Commands

    def save(self, folder: Path) -> None:
        """Save the run, as it is now, to a folder, with the validation under way at its end."""
        self._tell_validation(self.training.validate())
        super().save(folder)

    def _explain(self, slot: int | None) -> None:
        """Explain the learning step of a lander's latest memory; without one, of the most careful in the air."""
        self.messages.append(self._explanations.explain(self._explanations.aloft() if slot is None else slot))

    def _restore(self, decisions: int) -> None:
        """Restore the networks from the history's checkpoint of a moment; time does not go back."""
        checkpoint = self.history.checkpoint_at(decisions)
        if checkpoint is None:
            raise ValueError("this run has no checkpoints yet")
        checkpoint.restore(self.training.agent)
        self.record_change(REVERTED, None, checkpoint.decisions)
        self.show()

    commands = Session.commands | {"save": save, "restore": _restore, "explain": _explain}
