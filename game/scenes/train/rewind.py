"""Rewinding of a training run: the moment that Train shows instead of now, with all that was kept of it."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.training.messages import NetworkState, SwarmState
from game.core import texts
from game.drawing.tokens import HUMAN, SMALL
from game.training.run import TrainingRun
from game.ui.panel import Column

_STEPS: Final = 100  # presses of an arrow from the beginning of a run to its end


class Rewind:
    """Moment of a run, chosen on its charts; the run goes on learning meanwhile.

    What is shown is the nearest that was kept of each kind, never something between. Of a resumed run, the part from
    before has its curves and the networks of its checkpoints, but no landers.

    Attributes:
        moment: the moment that is shown, in decisions; None for now.
        swarm_state, network_state: the landers and the network of that moment; None if none were kept.

    """

    def __init__(self, run: TrainingRun) -> None:
        self._run = run
        self.clear()

    def clear(self) -> None:
        """Show now."""
        self.moment: int | None = None
        self.swarm_state: SwarmState | None = None
        self.network_state: NetworkState | None = None

    @property
    def row(self) -> int:
        """Number of the point of the history that is nearest to the moment; the last one for now."""
        return -1 if self.moment is None else self._run.history.row_at(self.moment)

    def go_to(self, decisions: float) -> None:
        """Show the kept moment nearest to one in decisions; from the last one on, show now."""
        run, known = self._run, self._run.history["decisions"]
        self.clear()
        if not len(known) or decisions >= known[-1]:
            return
        self.moment = int(known[run.history.row_at(decisions)])
        if run.swarms.begins is not None and decisions >= run.swarms.begins:
            self.swarm_state = run.swarms.nearest(decisions)
            assert self.swarm_state is not None
            self.moment = self.swarm_state.decisions
        self.network_state = self._network_at(self.moment)

    def shift(self, direction: int) -> None:
        """Go a hundredth of the run back (-1) or on (1)."""
        swarms, known = self._run.swarms, self._run.history["decisions"]
        if not len(known):
            return
        before = known if swarms.begins is None else known[known < swarms.begins]
        moments = np.concatenate([before, swarms.moments])
        here = int(np.searchsorted(moments, known[-1] if self.moment is None else self.moment))
        goal = max(here + direction * max(1, len(moments) // _STEPS), 0)
        self.go_to(float(moments[goal]) if goal < len(moments) else np.inf)

    def _network_at(self, decisions: int) -> NetworkState | None:
        """Return the nearest network: one the run has sent, or before the first of those, that of a checkpoint."""
        run, checkpoint = self._run, self._run.history.checkpoint_at(decisions)
        sent = run.networks.begins is not None and decisions >= run.networks.begins
        if sent or checkpoint is None or not checkpoint.values.size:
            return run.networks.nearest(decisions)
        nothing = np.zeros_like(checkpoint.values)
        return NetworkState(checkpoint.values, nothing, np.empty(0, np.float32), checkpoint.decisions)

    def describe(self, column: Column) -> None:
        """Add the moment, and the word that leads back to now."""
        if self.moment is not None:
            column.text(self._words, size=SMALL, colour=HUMAN)
            column.button(texts.REWIND_NOW, self.clear, colour=HUMAN)

    def _words(self) -> str:
        seconds = self._run.history["seconds"]
        return texts.REWIND_AT.format(seconds=float(seconds[self.row]), total=float(seconds[-1]))
