"""Base of the scenes in which a network is trained: a run in a process of its own, its display, and its knobs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, Final

from game.core import texts
from game.core.names import LibraryError
from game.core.scene import Pop, Push, Transition
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import PANEL, VIEW_SIZE
from game.input.controls import Command
from game.panels.knobs import KnobsPanel
from game.panels.run_status import draw_problem, start_label
from game.scenes.menus.dialogs import NameDialog
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FormScene

if TYPE_CHECKING:
    from game.training.run import TrainingRun
    from game.ui.widgets import TextButton

DISPLAY_WIDTH: Final = 836.0  # of what is seen of the run; the panel has the rest
PANEL_LEFT: Final = 868.0
LEFT: Final = 40.0


class TrainingScene(FormScene, ABC):
    """Scene of a training run: its display on the left, its knobs and the buttons that start and save it on the right.

    Args:
        context: the shared services.
        run: the run, and those that follow it; the scene locks the place of one without a name until it is left.
        problem_at: first baseline of why a run has failed, with the number of lines there is room for.

    Attributes:
        knobs: the panel of knobs; made by `_build`.
        start_button: the button that starts, pauses and resumes; made by `_build`.

    """

    knobs: KnobsPanel
    start_button: TextButton

    def __init__(self, context: Context, run: TrainingRun, problem_at: tuple[Point, int]) -> None:
        super().__init__(context, self._back)
        self._run, self._problem_at = run, problem_at
        self._settings = context.settings
        self._was_running = self._alive = False
        self._question: Transition | None = None  # asked after the next update
        try:
            self._build()
        except BaseException:  # nobody closes a scene that could not be built
            self.close()
            raise

    # What a subclass says

    @abstractmethod
    def _build(self) -> None:
        """Lock the place of a run without a name, and add the widgets."""

    @property
    @abstractmethod
    def _learnt(self) -> bool:
        """Whether the run has learnt anything yet."""

    @property
    def _back_hint(self) -> str:
        """What Escape does, in a word."""
        return texts.HINT_BACK

    @abstractmethod
    def _begin(self, config: Any, seed: int) -> None:
        """Start a run, once the player is content with what becomes of an earlier one."""

    @abstractmethod
    def _clear(self) -> None:
        """Empty the display, for another run."""

    @abstractmethod
    def _draw_display(self, canvas: Canvas, alpha: float) -> None:
        """Draw what is seen of the run."""

    @abstractmethod
    def _draw_advice(self, canvas: Canvas) -> None:
        """Draw a hint on what to do, where a failed run has its problem."""

    @abstractmethod
    def _save(self) -> Transition | None:
        """Ask for a name to save the run under."""

    def _save_as(self, name: str) -> str:
        """Save the run under a name; return why that failed, or ""."""
        try:
            if note := self._run.save(name):
                self.context.note(note)
        except LibraryError as error:
            return str(error)
        return ""

    # The run

    def enter(self) -> None:
        """Resume the run, after a duel with a checkpoint for instance."""
        if self._was_running:
            self._run.resume()

    def exit(self) -> None:
        """Pause the run while another scene has the window."""
        self._was_running = self._run.state in (WorkerState.RUNNING, WorkerState.STARTING)
        self._run.pause()

    def close(self) -> None:
        """End the run's process; its latest network is kept."""
        self._run.close()
        self._run.collection.release()

    def actions(self) -> Table:
        """Go back; step, start or pause, as the buttons say."""
        return [
            self.form.goes_back(self._back_hint),
            Action(Command.STEP, self._run.step),
            Action(Command.HANDOVER, self._toggle),
        ]

    def _follow_run(self) -> None:
        """Show the run's settings once it tells them, and whether it goes on."""
        run = self._run
        if run.begun:
            run.begun = False
            self.knobs.set_config(run.config, run.seed)
            run.call(self.knobs.name)  # of one that goes on, that is known only now
        if run.alive != self._alive:
            self._alive = run.alive
            self._clear_advice()
            self.knobs.set_running(self._alive)
        self.start_button.label = start_label(run.state)

    def _clear_advice(self) -> None:
        """Drop a hint on the run before."""

    def _ask_or(self, outcome: Transition | None) -> Transition | None:
        """Return the question that waits, if a widget has asked for no other scene."""
        question, self._question = self._question, None
        return outcome or question

    def _toggle(self) -> None:
        run = self._run
        if run.state is WorkerState.PAUSED:
            run.resume()
        elif run.alive:
            run.pause()
        else:
            self._begin(self.knobs.config, self.knobs.seed)

    def _start(self, config: Any, seed: int, resume: Any = None) -> None:
        """Start a run, or go on with the saved one `resume`, whose first message brings its real settings."""
        self._was_running = False
        if note := self._run.begin(config, seed, resume=resume, name=self.knobs.name):
            self.context.note(note)
        self._clear()
        if not resume:
            self.knobs.set_config(config, seed)

    def _ask_name(self, suggestion: str) -> Transition:
        return Push(NameDialog(self, texts.NAMING, self._run.collection.free_name(suggestion), self._save_as))

    def _back(self) -> Transition | None:
        """Leave; if the run has learnt anything, say that it is kept."""
        if self._run.alive and self._learnt:
            self.context.note(texts.TRAIN_KEPT)
        return Pop()

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the display, and the panel beside it."""
        self._draw_display(canvas, alpha)
        whole, view = canvas.whole, canvas.whole.view
        whole.fill(whole.rect(DISPLAY_WIDTH, view.top, view.right - DISPLAY_WIDTH, view.height), PANEL)
        self._draw_panel(canvas)
        if problem := self._run.problem:
            corner, most = self._problem_at
            draw_problem(canvas, problem, corner, VIEW_SIZE[0] - 28 - PANEL_LEFT, most)
        else:
            self._draw_advice(canvas)
        self.form.draw(canvas)

    def _draw_panel(self, canvas: Canvas) -> None:
        """Draw what is in the panel besides the widgets."""
        self.knobs.draw(canvas)
