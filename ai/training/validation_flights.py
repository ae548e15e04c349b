"""Validation of a live run's network, a few decisions at a time, so that the landers never stand still for it."""

from __future__ import annotations

from itertools import repeat

from ai.agent.normalizer import Normalizer
from ai.files import array_like, count_of
from ai.training.history import Validation
from ai.training.lander_task import Evaluation, LanderTask
from ai.training.loop import Training, passed
from ai.training.state import State
from ai.training.task import VALIDATION_SEED


class ValidationFlights:
    """Validation flights of a run's network as it is when they are due; the best network is kept in the Training.

    The flights are those of `Training.evaluate`, of the same networks at the same moments.
    """

    def __init__(self, training: Training) -> None:
        self._training = training
        self._trial: _Trial | None = None

    def go_on(self, before: int, decisions: int) -> Validation | None:
        """Fly a little; return the result once there is one.

        `before` are the decisions that the run had taken before its last one, `decisions` how many to take here.
        """
        finished = None
        if passed(before, self._training.agent.decisions, self._training.task.evaluate_every):
            finished = self.finish()
            self._trial = _Trial(self._training)
        elif self._trial is not None and self._trial.go_on(decisions):
            finished = self.finish()
        return finished

    def state(self) -> State | None:
        """Return the network whose flights are under way, if any; they begin again where a run goes on."""
        if self._trial is None:
            return None
        agent = self._trial.agent
        scale = agent.normalizer.to_json() if agent.normalizer else None
        return {"decisions": agent.decisions, "values": agent.network.values.copy(), "normalizer": scale}

    def load_state(self, state: State | None) -> None:
        """Begin the flights of a network that `state` returned; raises KeyError, TypeError or ValueError for others."""
        if state is not None:
            self._trial = _Trial(self._training)
            agent = self._trial.agent
            normalizer = Normalizer(agent.num_features) if agent.normalizer else None
            if normalizer:
                normalizer.load(state["normalizer"])
            agent.restore(array_like(agent.network.values, state["values"], "validated network"), normalizer)
            agent.decisions = count_of(state["decisions"])

    def finish(self) -> Validation | None:
        """Fly all that is left of a trial; return its result, or None if there is none going on."""
        if self._trial is None:
            return None
        trial, self._trial = self._trial, None
        trial.go_on()
        assert trial.score is not None
        best = self._training.keep_if_best(trial.score, trial.agent)
        return Validation(trial.agent.decisions, trial.score.success, trial.score.mean_return, best)


class _Trial:
    """Flights of a network as it is at the start."""

    def __init__(self, training: Training) -> None:
        assert training.validation_episodes is not None
        self.agent = training.last_agent()
        self.score: Evaluation | None = None
        assert isinstance(training.task, LanderTask)
        self._flights = training.task.trial(self.agent, training.validation_episodes, VALIDATION_SEED)

    def go_on(self, decisions: int | None = None) -> bool:
        """Take so many decisions, or all that are left; return whether the trial is done."""
        if self.score is None:  # flights that are over would have no score a second time
            try:
                for _ in range(decisions) if decisions else repeat(None):
                    next(self._flights)
            except StopIteration as done:
                self.score = done.value
        return self.score is not None
