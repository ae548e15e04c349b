"""Rewinding of a training run: the moment that Train shows instead of now, with all that was kept of it."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.environment import Doubles
from ai.training.messages import NetworkState
from game.core import texts
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, MUTE, SMALL
from game.scenes.train.charts import TrainingCharts
from game.scenes.train.inside import Inside
from game.training.run import TrainingRun
from game.ui.panel import Column
from game.ui.rows import SliderRow
from game.ui.widget import PointsManager
from game.world.swarm import LearningSwarm

_STEPS: Final = 100  # presses of an arrow from the beginning of a run to its end


class Rewind:
    """Moment of a run, chosen on its charts or its timeline; the run goes on learning meanwhile.

    What is shown is the nearest that was kept of each kind, never something between. Of a resumed run, the part from
    before has its curves and the networks of its checkpoints, but no landers.

    Attributes:
        moment: the moment that is shown, in decisions; None for now.
        swarm: the landers of that moment.
        swarm_kept: whether they were kept.
        network_state: the network of that moment; None if none was kept.

    """

    def __init__(self, lander_run: TrainingRun) -> None:
        self._run = lander_run
        self.swarm = LearningSwarm()
        self._timeline: SliderRow | None = None
        self.clear()

    def clear(self) -> None:
        """Show now."""
        self.moment: int | None = None
        self.swarm_kept = False
        self.network_state: NetworkState | None = None

    # Where it goes

    @property
    def row(self) -> int:
        """Number of the point of the history that is nearest to the moment; the last one for now."""
        if self.moment is None:
            return -1
        return self._run.history.row_at(self.moment)

    @property
    def share(self) -> float:
        """Place of the moment in the run, from 0, the beginning, to 1, now."""
        end = self._end
        return 1.0 if self.moment is None or not end else self.moment / end

    @property
    def _end(self) -> float:
        history = self._run.history
        return float(history["decisions"][-1]) if len(history) else 0.0

    def seek(self, decisions: float) -> None:
        """Show the kept moment nearest to one in decisions; from the last one on, show now."""
        history, run = self._run.history, self._run
        if not len(history) or decisions >= self._end:
            self.clear()
            return
        began = run.swarms.begins
        swarm_state = run.swarms.nearest(decisions) if began is not None and decisions >= began else None
        if swarm_state is not None:
            self.moment = swarm_state.decisions
        else:
            self.moment = int(history["decisions"][history.row_at(decisions)])
        self.swarm_kept = swarm_state is not None
        self.swarm.clear()
        if swarm_state is not None:
            self.swarm.take(swarm_state)
        self.network_state = self._network_at(self.moment)

    def seek_share(self, share: float) -> None:
        """Show the moment at a share of the run, from 0 to 1, which is now."""
        self.seek(share * self._end)

    def shift(self, direction: int) -> None:
        """Go a hundredth of the run back (-1) or on (1)."""
        if not self._end or (self.moment is None and direction > 0):
            return
        known = self._moments()
        step = max(1, len(known) // _STEPS)
        here = self._end if self.moment is None else self.moment
        before, after = np.searchsorted(known, here, "left") - step, np.searchsorted(known, here, "right") - 1 + step
        goal = int(before if direction < 0 else after)
        self.seek(float(known[max(goal, 0)]) if goal < len(known) else self._end)

    def _moments(self) -> Doubles:
        """Return all moments to be shown, rising: of the landers, and before those were kept, of the curves."""
        swarms, known = self._run.swarms, self._run.history["decisions"]
        before = known if swarms.begins is None else known[known < swarms.begins]
        return np.concatenate([before, swarms.moments])

    def _network_at(self, decisions: int) -> NetworkState | None:
        """Return the nearest network: one the run has sent, or before the first of those, that of a checkpoint."""
        run = self._run
        began = run.networks.begins
        if began is not None and decisions >= began:
            return run.networks.nearest(decisions)
        checkpoint = run.history.checkpoint_at(decisions)
        if checkpoint is None or not checkpoint.values.size:
            return run.networks.nearest(decisions)
        nothing = np.zeros_like(checkpoint.values)
        return NetworkState(checkpoint.values, nothing, np.empty(0, np.float32), checkpoint.decisions)

    # The picture

    def show_in(self, inside: Inside, charts: TrainingCharts) -> None:
        """Put the panels at the moment that was chosen, or back to now; call it once a frame."""
        run, moment = self._run, self.moment
        if self._timeline is not None and not self._timeline.held:
            self._timeline.value = self.share
        if moment == charts.moment:
            return
        charts.moment, inside.editing.past = moment, moment is not None
        network = run.network_state if moment is None else self.network_state
        if network is not None and network is not inside.shown:
            inside.show(network, run.config)
        if len(run.history):
            inside.pay(run.history, self.row)

    @property
    def words(self) -> str:
        """Sentence on the moment; empty for now."""
        if self.moment is None:
            return ""
        seconds = self._run.history["seconds"]
        words = texts.REWIND_AT_RUNNING if self._run.state is WorkerState.RUNNING else texts.REWIND_AT
        return words.format(seconds=float(seconds[self.row]), total=float(seconds[-1]))

    def describe(self, column: Column, manager: PointsManager, *, timeline: bool) -> None:
        """Add the moment, the word that leads back to now and, where no chart is seen, a timeline."""
        self._timeline = None
        if timeline and len(self._run.history):
            self._timeline = column.widget(_Timeline(manager, self))
        if self.moment is not None:
            column.text(lambda: self.words, size=SMALL, colour=HUMAN)
            column.button(texts.REWIND_NOW, self.clear, colour=HUMAN)

    def seconds_at(self, share: float) -> str:
        """Write the time at a share of the run."""
        return texts.REWIND_MARK.format(seconds=share * float(self._run.history["seconds"][-1]))

    def draw_swarm(self, canvas: Canvas, alpha: float) -> None:
        """Draw the landers of that moment, or say that they were not kept."""
        self.swarm.draw(canvas, alpha, paused=True)
        if not self.swarm_kept:
            canvas.text(texts.REWIND_NO_LANDERS, self.swarm.box.center, size=SMALL, colour=MUTE, align="centre")


class _Timeline(SliderRow):
    """Slider over the whole run; the arrows go from one kept moment to the next."""

    def __init__(self, manager: PointsManager, rewind: Rewind) -> None:
        super().__init__(
            manager, texts.REWIND_TIMELINE, rewind.share, (0.0, 1.0), rewind.seek_share, 0.0, rewind.seconds_at
        )
        self._rewind = rewind

    def shift(self, direction: int) -> bool:
        """Go a step back or on."""
        self._rewind.shift(direction)
        self.value = self._rewind.share
        return True
