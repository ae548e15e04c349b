"""Rewinding of a training run: the moment that Train shows instead of now, with all that was kept of it."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.environment import Doubles
from ai.training.messages import NetworkState, SwarmState
from game.core import texts
from game.core.worker import WorkerState
from game.drawing.tokens import HUMAN, SMALL
from game.training.run import TrainingRun
from game.ui.panel import Column
from game.ui.rows import SliderRow

_STEPS: Final = 100  # presses of an arrow from the beginning of a run to its end


class Rewind:
    """Moment of a run, chosen on its charts or its timeline; the run goes on learning meanwhile.

    What is shown is the nearest that was kept of each kind, never something between. Of a resumed run, the part from
    before has its curves and the networks of its checkpoints, but no landers.

    Attributes:
        moment: the moment that is shown, in decisions; None for now.
        swarm_state, network_state: the landers and the network of that moment; None if none were kept.

    """

    def __init__(self, run: TrainingRun) -> None:
        self._run = run
        self._timeline: SliderRow | None = None
        self.clear()

    def clear(self) -> None:
        """Show now."""
        self.moment: int | None = None
        self.swarm_state: SwarmState | None = None
        self.network_state: NetworkState | None = None

    # Where it goes

    @property
    def row(self) -> int:
        """Number of the point of the history that is nearest to the moment; the last one for now."""
        return -1 if self.moment is None else self._run.history.row_at(self.moment)

    @property
    def share(self) -> float:
        """Place of the moment in the run, from 0, the beginning, to 1, now."""
        return 1.0 if self.moment is None or not self._end else self.moment / self._end

    @property
    def _end(self) -> float:
        return float(self._run.history["decisions"][-1]) if len(self._run.history) else 0.0

    def go_to(self, decisions: float) -> None:
        """Show the kept moment nearest to one in decisions; from the last one on, show now."""
        run = self._run
        self.clear()
        if not len(run.history) or decisions >= self._end:
            return
        self.moment = int(run.history["decisions"][run.history.row_at(decisions)])
        if run.swarms.begins is not None and decisions >= run.swarms.begins:
            self.swarm_state = run.swarms.nearest(decisions)
            assert self.swarm_state is not None
            self.moment = self.swarm_state.decisions
        self.network_state = self._network_at(self.moment)

    def go_to_share(self, share: float) -> None:
        """Show the moment at a share of the run, from 0 to 1, which is now."""
        self.go_to(share * self._end)

    def shift(self, direction: int) -> None:
        """Go a hundredth of the run back (-1) or on (1)."""
        if not self._end or (self.moment is None and direction > 0):
            return
        known = self._moments()
        step = max(1, len(known) // _STEPS)
        here = self._end if self.moment is None else self.moment
        before, after = np.searchsorted(known, here, "left") - step, np.searchsorted(known, here, "right") - 1 + step
        goal = int(before if direction < 0 else after)
        self.go_to(float(known[max(goal, 0)]) if goal < len(known) else self._end)

    def _moments(self) -> Doubles:
        """Return all moments to be shown, rising: of the landers, and before those were kept, of the curves."""
        swarms, known = self._run.swarms, self._run.history["decisions"]
        before = known if swarms.begins is None else known[known < swarms.begins]
        return np.concatenate([before, swarms.moments])

    def _network_at(self, decisions: int) -> NetworkState | None:
        """Return the nearest network: one the run has sent, or before the first of those, that of a checkpoint."""
        run, checkpoint = self._run, self._run.history.checkpoint_at(decisions)
        sent = run.networks.begins is not None and decisions >= run.networks.begins
        if sent or checkpoint is None or not checkpoint.values.size:
            return run.networks.nearest(decisions)
        nothing = np.zeros_like(checkpoint.values)
        return NetworkState(checkpoint.values, nothing, np.empty(0, np.float32), checkpoint.decisions)

    # The words

    @property
    def words(self) -> str:
        """Sentence on the moment; empty for now."""
        if self.moment is None:
            return ""
        seconds = self._run.history["seconds"]
        words = texts.REWIND_AT_RUNNING if self._run.state is WorkerState.RUNNING else texts.REWIND_AT
        return words.format(seconds=float(seconds[self.row]), total=float(seconds[-1]))

    def describe(self, column: Column, *, timeline: bool) -> None:
        """Add the moment, the word that leads back to now and, where no chart is seen, a timeline."""
        self._timeline = None
        if timeline and len(self._run.history):
            self._timeline = column.widget(_Timeline(self))
        if self.moment is not None:
            column.text(lambda: self.words, size=SMALL, colour=HUMAN)
            column.button(texts.REWIND_NOW, self.clear, colour=HUMAN)

    def update(self) -> None:
        """Let the timeline follow."""
        if self._timeline is not None and not self._timeline.held:
            self._timeline.value = self.share

    def seconds_at(self, share: float) -> str:
        """Write the time at a share of the run."""
        return texts.REWIND_MARK.format(seconds=share * float(self._run.history["seconds"][-1]))


class _Timeline(SliderRow):
    """Slider over the whole run; the arrows go from one kept moment to the next."""

    def __init__(self, rewind: Rewind) -> None:
        label, share, change = texts.REWIND_TIMELINE, rewind.share, rewind.go_to_share
        super().__init__(label, share, (0.0, 1.0), change, step=0.001, figure=rewind.seconds_at)
        self._rewind = rewind

    def shift(self, direction: int) -> bool:
        """Go a step back or on."""
        self._rewind.shift(direction)
        self.value = self._rewind.share
        return True
