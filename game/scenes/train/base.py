"""Training of a network: a run in a process of its own, what is seen of it, its charts, and a panel of words."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import pygame

from game.core import texts
from game.core.scene import Pop, Push, Transition
from game.core.shelf import LibraryError
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, INK, PANEL, SMALL, TITLE
from game.explain.explained import Explained
from game.input.controls import Command
from game.scenes.menus.dialogs import NameDialog
from game.scenes.train.charts import TrainingCharts
from game.scenes.train.knobs import KnobsPanel
from game.scenes.train.layout import Layout, TrainingStatus, hint_row, layout
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form import Form, FormScene
from game.ui.hints import HintRow
from game.ui.panel import Column, Panel
from game.ui.widget import Widget

if TYPE_CHECKING:
    from pathlib import Path

    from game.training.run import TrainingRun
    from game.ui.rows import ButtonRow

_MARGIN: Final = 32.0  # of the panel
_LEAST: Final = 80.0  # points of height for the title above the charts
_FOOT: Final = 0.8  # share of the panel that its foot takes at most
MORE: Final = "more"  # what a player can open: the words for all else, every chart, every knob, the network
CHARTS: Final = "charts"
KNOBS: Final = "knobs"
INSIDE: Final = "inside"


Pointer = tuple[Widget, Callable[[], pygame.typing.RectLike]]


class TrainingScene(FormScene, ABC):
    """Scene of a training run: what is seen of it, and a panel with its knobs and the button that starts it.

    The panel is laid anew whenever other rows are to be seen. What the player opens stays open in later visits. A
    subclass makes `knobs` and `charts` in `_build`, and says what is seen of its kind of run.

    Args:
        context: the shared services.
        run: the run, and those that follow it; the scene locks the place of one without a name until it is left.

    Attributes:
        run: the run, with the experiment beside it.
        left: the run that was left without a name by the last visit; None without one.
        knobs, charts: the panel of knobs, and the curves.
        start_button: the button that starts, pauses and resumes.

    """

    knobs: KnobsPanel
    charts: TrainingCharts
    panel: Panel
    start_button: ButtonRow

    def __init__(self, context: Context, run: TrainingRun) -> None:
        super().__init__(context, self._back)
        self.run, self._settings = run, context.settings
        self._was_running = self._alive = False
        self._laid: Hashable = None
        self._page = ""
        self._layout: Layout | None = None
        self.explained = Explained()
        try:
            run.keeps = run.collection.hold()
            if not run.keeps:
                context.note(texts.TRAIN_ELSEWHERE)
            self.left = run.collection.rescued() if run.keeps else None
            self._build()
            self._lay()
            self.form.focus(self.start_button)
            self.lay_out()
        except BaseException:  # nobody closes a scene that could not be built
            self.close()
            raise

    # What a subclass says

    @abstractmethod
    def _build(self) -> None:
        """Make what is shown."""

    @property
    @abstractmethod
    def _key(self) -> Hashable:
        """What else decides which rows there are."""

    @property
    @abstractmethod
    def _status(self) -> TrainingStatus:
        """What the run has come to."""

    @property
    @abstractmethod
    def _suggestion(self) -> str:
        """Name for the run, after its settings."""

    @property
    @abstractmethod
    def _unfinished(self) -> str:
        """What is said of a run that was left, and can go on; empty without one."""

    @property
    @abstractmethod
    def _worth_keeping(self) -> bool:
        """Whether there is a run without a name that has learnt."""

    @abstractmethod
    def _clear(self) -> None:
        """Empty the display, for another run."""

    @abstractmethod
    def _place(self, place: Layout) -> None:
        """Move what is seen of the run to its boxes."""

    @abstractmethod
    def _pointers(self) -> list[Pointer]:
        """Return new widgets for what is seen of the run, each with what gives its box once all is placed."""

    @abstractmethod
    def _describe_more(self, column: Column) -> None:
        """Add what a press on *More* opens."""

    @abstractmethod
    def _describe_hint(self, column: Column) -> bool:
        """Add a hint on what to do; return whether there is one."""

    @abstractmethod
    def _draw_display(self, canvas: Canvas, alpha: float) -> None:
        """Draw what is seen of the run, without its charts."""

    # What the player opens

    def opened(self, name: str) -> bool:
        """Whether a part is open."""
        return self._settings.is_open(name)

    def open(self, name: str) -> None:
        """Open a part, or close it; it stays so for this player."""
        self._settings.unfold(name)
        self.context.apply_settings()

    def switch(self, column: Column, name: str) -> None:
        """Add the word that opens a part, or closes it."""
        words = {
            MORE: texts.MORE,
            CHARTS: texts.TRAIN_MORE_CHARTS,
            KNOBS: texts.TRAIN_MORE_KNOBS,
            INSIDE: texts.TRAIN_LOOK,
        }
        column.button(words[name][self.opened(name)], partial(self.open, name)).pad = 3.0

    # Rows

    def _lay(self) -> None:
        """Describe the panel anew; the focus stays on what has the same name."""
        before, page, self._page = self.form, self._page, self._shown_page
        scrolled = self.panel.scrolled if self._laid is not None and page == self._page else 0.0
        self.form = self.knobs.form = Form(self.context, before.back)
        self.knobs.every = self.opened(KNOBS)
        self.panel, self._foot = Panel(self.form), Panel(self.form)
        self._pointed = self._pointers()
        for widget, _ in self._pointed:
            self.form.add(widget)
        self._describe(self.panel)
        self._describe_foot(self._foot)
        self.form.follow(before, self.start_button)
        if page != self._page and self.panel.widgets:  # from its top
            self.form.focus(self.panel.widgets[0])
        self._laid, self._layout = self._rows_key, None
        self.lay_out()
        self.panel.scroll(scrolled)

    @property
    def _shown_page(self) -> str:
        """Which page the panel shows, of scenes that have several."""
        return ""

    @property
    def _rows_key(self) -> Hashable:
        run = self.run
        return self._settings.opened, self.knobs.key, self._key, bool(run.problem), run.alive, bool(self._unfinished)

    def _describe(self, column: Column) -> None:
        """Add the rows of the panel."""
        self.knobs.describe(column)
        column.gap()
        self.switch(column, MORE)
        if self.opened(MORE):
            self._describe_more(column)

    def _describe_foot(self, column: Column) -> None:
        """Add what went wrong, or a hint, or help; the run that can go on; and the button that starts."""
        if self.run.problem:
            column.text(lambda: self.run.problem, size=SMALL, colour=HUMAN)
        elif not self._describe_hint(column):
            self.knobs.describe_foot(column)
        if words := self._unfinished:
            column.button(texts.TRAIN_GO_ON, self._go_on_with_last, words, colour=HUMAN)
        column.gap()
        self.start_button = column.button(self._start_label, self._toggle, size=TITLE, colour=INK)
        self.start_button.pad = 2.0

    def lay_out(self) -> None:
        """Lay everything out for the window as it is."""
        canvas = self.context.reading()
        for more in (self.opened(CHARTS), False):
            self.charts.show(more=more)
            place = layout(canvas.view, len(self.charts.charts))
            if place.swarm.height >= _LEAST:  # or else there is no room for every chart
                break
        if place != self._layout:
            self._layout = place
            self.charts.place(place.charts)
            self._place(place)
            for widget, box in self._pointed:
                widget.relative_rect = widget.rect = pygame.Rect(box())
        panel = place.panel.inflate(-2 * _MARGIN, -2 * 20.0)
        room = pygame.FRect(panel.left, panel.top, panel.width, _FOOT * panel.height)
        self._foot.lay_out(room, canvas.scale)
        height = min(self._foot.height, room.height)
        self._foot.lay_out(pygame.FRect(panel.left, panel.bottom - height, panel.width, height + 1), canvas.scale)
        self.panel.lay_out(pygame.FRect(panel.topleft, (panel.width, panel.height - height - 10)), canvas.scale)

    # Events and time

    def enter(self) -> None:
        """Resume the run, after a duel with a checkpoint for instance."""
        if self._was_running:
            self.run.resume()

    def exit(self) -> None:
        """Pause the run while another scene has the window."""
        self._was_running = self.run.state in (WorkerState.RUNNING, WorkerState.STARTING)
        self.run.pause()

    def close(self) -> None:
        """End the run's process; its latest network is kept."""
        self.run.close()
        self.run.collection.release()

    def actions(self) -> Table:
        """Go back; start or pause, as the button says."""
        return [
            self.form.goes_back(self._back_hint),
            Action(Command.HANDOVER, self._toggle),
            self.explained.action(),
        ]

    def hint_rows(self, canvas: Canvas) -> Sequence[HintRow]:
        return [hint_row(self._layout, self.hints[:1])] if self._layout else []

    @property
    def _back_hint(self) -> str:
        """What Escape does, in a word."""
        return texts.HINT_BACK

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Go on explaining; scroll the panel by the wheel; everything else is the form's."""
        if self.explained.handle_event(event):
            return None
        outcome = super().handle_event(event)
        over = self._layout is not None and self._layout.panel.collidepoint(self.form.manager.mouse_position)
        if event.type == pygame.MOUSEWHEEL and not self.form.used and over:
            self.form.used = self.panel.turn_wheel(event.y)
        return outcome

    def _listen(self) -> None:
        """Receive the worker's messages; show the run's settings once it tells them, and whether it goes on."""
        run = self.run
        for note in run.poll():
            self.context.note(note)
        if run.begun:
            run.begun = False
            self.knobs.set_config(run.config, run.seed)
            run.call(self.knobs.name)  # of one that goes on, that is known only now
        if run.alive != self._alive:
            self._alive = run.alive
            self.knobs.set_running(self._alive)
        self.start_button.label = self._start_label

    @property
    def _start_label(self) -> str:
        """What the button says that starts, pauses and resumes the run."""
        if self.run.state in (WorkerState.RUNNING, WorkerState.STARTING):
            return texts.TRAIN_PAUSE
        return texts.TRAIN_RESUME if self.run.state is WorkerState.PAUSED else texts.TRAIN_START

    def _finish_update(self) -> Transition | None:
        """Animate the widgets, lay them anew where others are wanted, and return what is to come next."""
        self.explained.update()
        outcome = self.form.update()
        if self._rows_key != self._laid and not any(widget.held or widget.typing for widget in self.form.widgets):
            self._lay()
        self.lay_out()
        return outcome

    # The run

    def _toggle(self) -> None:
        run = self.run
        if run.state is WorkerState.PAUSED:
            run.resume()
        elif run.alive:
            run.pause()
        else:
            self._begin(self.knobs.config, self.knobs.seed)

    def _begin(self, config: Any, seed: int) -> None:
        """Start a run; one that has learnt and has no name is put among the player's networks."""
        if self._keep():
            self._start(config, seed)

    def _keep(self) -> bool:
        """Put a run that has learnt and has no name among the player's networks; False, and a note, if that failed."""
        if not self._worth_keeping:
            return True
        runs = self.run.collection
        name = runs.free_name(self._suggestion if self.run.runs else runs.rescued_name)
        if problem := self._save_as(name):
            self.context.note(problem)
        return not problem

    def _start(self, config: Any, seed: int, resume: Path | None = None) -> None:
        """Start a run, or go on with the saved one `resume`, whose first message brings its real settings."""
        self._was_running = False
        if note := self.run.begin(config, seed, resume=resume, name=self.knobs.name):
            self.context.note(note)
        self._clear()
        if not resume:
            self.knobs.set_config(config, seed)

    def _go_on_with_last(self) -> None:
        self._start(self.knobs.config, self.knobs.seed, self.run.collection.unsaved)

    def _save(self) -> Transition | None:
        """Ask for a name to save the run under."""
        if not (self.run.alive or self.run.kept):
            self.context.note(texts.TRAIN_NOTHING)
            return None
        return Push(NameDialog(self, texts.NAMING, self.run.collection.free_name(self._suggestion), self._save_as))

    def _save_as(self, name: str) -> str:
        """Save the run under a name; return why that failed, or ""."""
        try:
            if note := self.run.save(name):
                self.context.note(note)
        except LibraryError as error:
            return str(error)
        return ""

    def _back(self) -> Transition | None:
        """Leave; if the run has learnt anything, say that it is kept."""
        if self.run.keeps and self.run.alive and len(self.run.history):
            self.context.note(texts.TRAIN_KEPT)
        return Pop()

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the display, and the panel beside it."""
        self._draw_display(canvas, alpha)
        assert self._layout is not None
        canvas.fill(canvas.rect(*self._layout.panel), PANEL)
        self.panel.draw(canvas)
        self._foot.draw(canvas)
        self.form.draw(canvas)
        self.explained.draw(canvas)

    def draw_title(self, canvas: Canvas) -> None:
        """Draw what the run has come to, over the display."""
        assert self._layout is not None
        self._status.draw(canvas, self._layout)
        self.draw_hints(canvas)
