"""Rewinding of a training run: the moment that Train shows instead of now, with all that was kept of it."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.environment import Doubles
from ai.training.messages import NetworkState
from game.core import texts
from game.core.worker import WorkerState
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, MUTE, SMALL
from game.panels.network_panel import NetworkPanel
from game.panels.run_timeline import RunTimeline
from game.panels.training_charts import TrainingCharts
from game.training.run import TrainingRun
from game.ui.form import Form
from game.ui.widget import Widget
from game.ui.widgets import TextButton
from game.world.swarm import LearningSwarm

_PLACES: Final = ((40.0, 420.0), (460.0, 46.0))  # baseline of the words: over the swarm, beside the large network
_BESIDE: Final = (40.0, 170.0)  # over two swarms, whose names stand below them
_TIMELINE: Final = (460, 88, 360, 28)  # beside the large network
_APART: Final = 16.0  # points between the sentence and the word that leads back
_MIDDLE: Final = (430.0, 250.0)
_STEPS: Final = 100  # presses of an arrow from the beginning of a run to its end
_COVER: Final = 0.88


class Rewind:
    """Moment of a run, chosen on its charts or its timeline; the run goes on learning meanwhile.

    What is shown is the nearest that was kept of each kind, never something between. Of a resumed run, the part from
    before has its curves and the networks of its checkpoints, but no landers.

    Attributes:
        moment: the moment that is shown, in decisions; None for now.
        swarm: the landers of that moment.
        swarm_kept: whether they were kept.
        split: whether another swarm is beside them.
        network_state: the network of that moment; None if none was kept.

    """

    def __init__(self, form: Form, lander_run: TrainingRun, width: float) -> None:
        self._form, self._run = form, lander_run
        self.swarm = LearningSwarm(width)
        self._words: list[TextButton] = []
        self._large = False
        self.split = False  # whether there are two swarms
        self.clear()

    def clear(self) -> None:
        """Show now."""
        self.moment: int | None = None
        self.swarm_kept = False
        self.network_state: NetworkState | None = None
        self._lay()

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
        self._lay()

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

    def show_in(self, inside: NetworkPanel, charts: TrainingCharts) -> None:
        """Put the panels at the moment that was chosen, or back to now; call it once a frame."""
        self._lay()  # the sentence grows as the run goes on
        run, moment = self._run, self.moment
        if moment == charts.moment:
            return
        charts.moment, inside.editing.past = moment, moment is not None
        network = run.network_state if moment is None else self.network_state
        if network is not None and network is not inside.shown:
            inside.show(network, run.config)
        if len(run.history):
            inside.pay(run.history, self.row)

    def place(self, large: bool) -> list[Widget]:
        """Lay the words beside the swarm, or the large network; return the timeline that stands beside that."""
        self._large = large
        self._lay()
        return [RunTimeline(self._form.manager, _TIMELINE, self)] if large else []

    @property
    def words(self) -> str:
        """Sentence on the moment; empty for now."""
        if self.moment is None:
            return ""
        seconds = self._run.history["seconds"]
        words = texts.REWIND_AT_RUNNING if self._run.state is WorkerState.RUNNING else texts.REWIND_AT
        return words.format(seconds=float(seconds[self.row]), total=float(seconds[-1]))

    @property
    def _place(self) -> tuple[float, float]:
        return _BESIDE if self.split and not self._large else _PLACES[self._large]

    def _lay(self) -> None:
        """Add or remove the word that leads back to now, and keep it beside the sentence."""
        words = []
        if self.moment is not None:
            (left, baseline), height = self._place, 24
            left += typeface.width(self.words, SMALL, "regular") + _APART
            box = (left, baseline - 16, typeface.width(texts.REWIND_NOW, SMALL, "regular"), height)
            if self._words and self._words[0].box.topleft == (int(box[0]), int(box[1])):
                return
            if self._words:  # it only moves: a press on it goes on
                self._words[0].set_relative_position(box[:2])
                return
            words = [TextButton(self._form.manager, box, texts.REWIND_NOW, self.clear, size=SMALL, colour=HUMAN)]
        if words or self._words:
            old, self._words = self._words, words
            self._form.replace(old, words)

    def draw(self, canvas: Canvas) -> None:
        """Draw the sentence, and say so where there are no landers to be shown."""
        if self.moment is None:
            return
        left, baseline = self._place
        if not self._large:
            right = self._words[0].box.right if self._words else left
            canvas.panel((24, baseline - 20, right - 24 + 16, 30), _COVER)
            if not self.swarm_kept:
                canvas.text(texts.REWIND_NO_LANDERS, _MIDDLE, size=SMALL, colour=MUTE, align="centre")
        canvas.text(self.words, (left, baseline), size=SMALL, colour=HUMAN, tabular=True)
