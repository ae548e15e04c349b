"""Base of the scenes in which a network is trained: a run in a process of its own, its display, and its panel."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Hashable
from typing import TYPE_CHECKING, Any, Final

import pygame

from game.core import texts
from game.core.names import LibraryError
from game.core.scene import Pop, Push, Transition
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import INK, MUTE, PANEL, SMALL, TITLE
from game.input.controls import Command
from game.panels.run_status import rate_colour
from game.scenes.menus.dialogs import NameDialog
from game.scenes.train.knobs import KnobsPanel
from game.scenes.train.layout import Layout, layout
from game.scenes.train.status import TrainingStatus
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form import Part
from game.ui.form_scene import FormScene
from game.ui.hints import HintRow
from game.ui.panel import Column, Panel
from game.ui.widget import Widget

if TYPE_CHECKING:
    from game.training.run import TrainingRun
    from game.ui.rows import ButtonRow

_MARGIN: Final = 32.0  # of the panel
_TITLE: Final = (24.0, 16.0)  # corner of the title over the display
_WIDEST: Final = 372.0
_FIGURE: Final = (30.0, 60.0, 0.14)  # size at least, at most, and as a share of the picture's height
_COVER: Final = 0.82  # of the panel behind the title: landers are many, and bright
_FOOT: Final = 0.8  # share of the panel that its foot takes at most
MORE: Final = "more"  # what a player can open: the words for all else, every chart, every knob, the network
CHARTS: Final = "charts"
KNOBS: Final = "knobs"
INSIDE: Final = "inside"


class TrainingScene(FormScene, ABC):
    """Scene of a training run: what is seen of it, and a panel with its knobs and the button that starts it.

    The panel is laid anew whenever other rows are to be seen. What the player opens stays open in later visits.

    Args:
        context: the shared services.
        run: the run, and those that follow it; the scene locks the place of one without a name until it is left.

    Attributes:
        knobs: the panel of knobs; made by `_build`.
        start_button: the button that starts, pauses and resumes.

    """

    flows = True
    knobs: KnobsPanel
    panel: Panel
    start_button: ButtonRow

    def __init__(self, context: Context, run: TrainingRun) -> None:
        super().__init__(context, self._back)
        self.form.in_order = True
        self._run = run
        self._settings = context.settings
        self._was_running = self._alive = False
        self._question: Transition | None = None  # asked after the next update
        self._laid: Hashable = None
        self._layout: Layout | None = None
        try:
            self._build()
            self.knobs.every = self.opened(KNOBS)
            self._lay()
            self.form.focus(self.start_button)
            self.lay_out()
        except BaseException:  # nobody closes a scene that could not be built
            self.close()
            raise

    # What a subclass says

    @abstractmethod
    def _build(self) -> None:
        """Lock the place of a run without a name, and make what is shown."""

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
    def _save(self) -> Transition | None:
        """Ask for a name to save the run under."""

    @property
    def charts_shown(self) -> int:
        """Number of charts."""
        return 0

    @property
    def _key(self) -> Hashable:
        """What else decides which rows there are."""
        return None

    def _place(self, place: Layout) -> None:
        """Move what is seen of the run to its boxes."""

    def _pointers(self) -> list[Widget]:
        """Return new widgets for what is seen of the run."""
        return []

    def _describe(self, column: Column) -> None:
        """Add the rows of the panel."""
        self.knobs.describe(column)
        self._describe_more(column)

    def _describe_hint(self, column: Column) -> bool:
        """Add a hint on what to do; return whether there is one."""
        return False

    @abstractmethod
    def _describe_more(self, column: Column) -> None:
        """Add what can be opened."""

    def _save_as(self, name: str) -> str:
        """Save the run under a name; return why that failed, or ""."""
        try:
            if note := self._run.save(name):
                self.context.note(note)
        except LibraryError as error:
            return str(error)
        return ""

    # What the player opens

    def opened(self, name: str) -> bool:
        """Whether a part is open."""
        return self._settings.is_open(name)

    def open(self, name: str) -> None:
        """Open a part, or close it; it stays so for this player."""
        self._settings.open(name)
        self.context.apply_settings()
        self.knobs.every = self.opened(KNOBS)

    # Rows

    def _lay(self) -> None:
        """Describe the panel anew; the focus stays on what has the same name."""
        form, before, focused = self.form, list(self.form.widgets), self.form.focused
        scrolled = self.panel.scrolled if self._laid is not None else 0.0
        body, foot = Part(form), Part(form)
        self.panel, self._foot = Panel(body), Panel(foot)
        pointers = self._pointers()
        self._describe(self.panel)
        self._describe_foot(self._foot)
        for row in (*self.panel.rows, *self._foot.rows):
            row.what = ""  # a word that is read needs no tooltip; the help of a knob stands at the foot
        form.replace(before, [*pointers, *body.widgets, *foot.widgets])
        if focused is not None and focused not in form.widgets:
            alike = (each for each in form.widgets if type(each) is type(focused) and each.label == focused.label)
            form.focus(next(alike, self.start_button))
        self._laid, self._layout = self._rows_key, None
        self.lay_out()
        self.panel.scroll(scrolled)

    @property
    def _rows_key(self) -> Hashable:
        return self._settings.opened, self.knobs.key, self._key, bool(self._run.problem)

    def _describe_foot(self, column: Column) -> None:
        """Add what went wrong, or a hint, or help, and the button that starts."""
        if self._run.problem:
            column.add(self._write_problem)
        elif not self._describe_hint(column):
            self.knobs.describe_foot(column)
        column.gap()
        self.start_button = column.button(self._start_label, self._toggle, size=TITLE, colour=INK)
        self.start_button.pad = 2.0

    def _write_problem(self, cursor: Cursor) -> None:
        small = cursor.in_style(SMALL, cursor.canvas.palette.warn if cursor.canvas else MUTE)
        small.text(self._run.problem)
        cursor.y = small.y

    def switch(self, column: Column, name: str, words: tuple[str, str]) -> None:
        """Add the word that opens a part, or closes it."""
        column.button(words[self.opened(name)], lambda: self.open(name)).pad = 3.0

    def lay_out(self) -> None:
        """Lay everything out for the window as it is."""
        canvas = self.context.reading()
        place = layout(canvas.view, self.charts_shown)
        if place != self._layout:
            self._layout = place
            self._place(place)
        box = place.panel.inflate(-2 * _MARGIN, -2 * 20.0)
        room = pygame.FRect(box.left, box.top, box.width, _FOOT * box.height)
        self._foot.lay_out(room, canvas.scale)
        height = min(self._foot.height, room.height)
        self._foot.lay_out(pygame.FRect(box.left, box.bottom - height, box.width, height + 1), canvas.scale)
        self.panel.lay_out(pygame.FRect(box.left, box.top, box.width, box.height - height - 10), canvas.scale)

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

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Scroll the panel by the wheel; everything else is the form's."""
        outcome = super().handle_event(event)
        over = self._layout is not None and self._layout.panel.collidepoint(self.form.manager.mouse_position)
        if event.type == pygame.MOUSEWHEEL and not self.form.used and over:
            self.form.used = self.panel.turn_wheel(event.y)
        return outcome

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
        self.start_button.label = self._start_label

    @property
    def _start_label(self) -> str:
        """What the button says that starts, pauses and resumes the run."""
        if self._run.state in (WorkerState.RUNNING, WorkerState.STARTING):
            return texts.TRAIN_PAUSE
        return texts.TRAIN_RESUME if self._run.state is WorkerState.PAUSED else texts.TRAIN_START

    def _clear_advice(self) -> None:
        """Drop a hint on the run before."""

    def _finish_update(self) -> Transition | None:
        """Animate the widgets, lay them anew where others are wanted, and return what is to come next."""
        outcome = self.form.update()
        if self._rows_key != self._laid and not any(widget.held or widget.typing for widget in self.form.widgets):
            self._lay()
        self.lay_out()
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
        if self._layout is not None:
            canvas.fill(canvas.rect(*self._layout.panel), PANEL)
        self.panel.draw(canvas)
        self._foot.draw(canvas)
        self.form.draw(canvas)

    @property
    def _figure_size(self) -> float:
        """Size of the share that succeeds, smaller over a low picture."""
        assert self._layout is not None
        return min(max(_FIGURE[2] * self._layout.swarm.height, _FIGURE[0]), _FIGURE[1])

    def draw_title(self, canvas: Canvas, title: str, status: TrainingStatus) -> None:
        """Draw the title over the display, and the share that succeeds, large."""
        left, top = _TITLE
        assert self._layout is not None
        width = min(_WIDEST, self._layout.display.width - 2 * left)
        measured = Cursor(left + 16, top + 10, width - 32, canvas.scale)
        self._write_title(measured, title, status)
        canvas.panel((left, top, width, measured.y - top + 8), _COVER)
        self._write_title(Cursor(left + 16, top + 10, width - 32, canvas.scale, canvas), title, status)
        canvas.explain((left, top, width, measured.y - top + 8), texts.EXPLAIN_TRAINED)
        hints = HintRow(self.hints[:1], (left + width - 16, top + 30), from_right=True)
        hints.draw(canvas)

    def _write_title(self, cursor: Cursor, title: str, status: TrainingStatus) -> None:
        head = cursor.in_style(TITLE)
        head.text(title)
        cursor.y = head.y
        if status.figure:
            size = self._figure_size
            large = cursor.in_style(size, weight="light")
            wide = large.measured(status.figure, tabular=True)
            if canvas := cursor.canvas:
                large.colour = rate_colour(canvas.palette, float(status.figure))
                place = cursor.left - 2, cursor.y + 0.92 * size
                canvas.text(status.figure, place, size=size, weight="light", tabular=True, colour=large.colour)
                canvas.text(status.words, (cursor.left + wide + 10, place[1]), size=SMALL, colour=MUTE,
                            room=cursor.width - wide - 10)  # fmt: skip
            cursor.gap(1.08 * size)
        cursor.aside(status.line)
