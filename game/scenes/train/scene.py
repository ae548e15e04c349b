"""Train scene: a run in a process of its own, what is seen of it, its charts, and a panel of words."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import pygame

from game.core import texts
from game.core.scene import Pop, Push, Transition
from game.core.shelf import LibraryError
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, INK, LINE, NIGHT0, PANEL, SMALL, TITLE
from game.explain.explained import Explained
from game.input.controls import Command
from game.scenes.menus.dialogs import NameDialog, QuestionDialog
from game.scenes.train.charts import FEW_CHARTS, TrainingCharts
from game.scenes.train.knobs import KnobsPanel
from game.scenes.train.landers import LanderView
from game.scenes.train.layout import Layout, hint_row, is_low, layout
from game.training.run import PACES, TrainingRun
from game.training.run_settings import RunSettings
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form import FormScene
from game.ui.hints import HintRow
from game.ui.panel import Column, Panel

if TYPE_CHECKING:
    from pathlib import Path

    from game.scenes.train.view import View
    from game.ui.rows import ButtonRow

_MARGIN: Final = 32.0  # of the panel
_LEAST: Final = 80.0  # points of height for the title above the charts
_FOOT: Final = 0.8  # share of the panel that its foot takes at most
_LOW: Final = 220.0  # points of height, below which the foot scrolls with all else
_LOOKS: Final = 10  # frames from one look at the run to the next
MORE: Final = "more"  # what a player can open: the words for all else, and every chart
CHARTS: Final = "charts"


class TrainScene(FormScene):
    """Train scene: what is seen of a run, and a panel with its knobs and the button that starts it.

    Some six times a second it looks at the run: title, halves, charts and verdict all say what it saw then. The panel
    is laid anew whenever other rows are to be seen. What the player opens stays open in later visits.

    Args:
        context: the shared services.
        view: the kind of runs, as it is seen.
        resume: a saved run that goes on at once.

    Attributes:
        run: the run, with the experiment beside it; the place of one without a name is locked until the scene is left.
        left: the run that was left without a name by the last visit; None without one.
        view, knobs, charts: what is seen of the run, the panel of knobs, and the curves.
        landed: percent of each run that succeeds, at the last look; None before there is a number.
        start_button: the button that starts, pauses and resumes.

    """

    _foot: Panel
    start_button: ButtonRow

    def __init__(self, context: Context, view: type[View] = LanderView, resume: Path | None = None) -> None:
        super().__init__(context, self._back)
        self.run = run = TrainingRun(view.kind, view.collection(context.user_dir))
        self._settings, self._was_running, self._frame, self._alive = context.settings, False, 0, False
        self._page: Hashable = False
        self.panel = Panel(self.form)
        self._seen: Hashable = None
        self._layout: Layout | None = None
        self.landed: tuple[int | None, ...] = ()
        self.explained = Explained()
        try:
            run.keeps = run.collection.hold()
            if not run.keeps:
                context.note(texts.TRAIN_ELSEWHERE)
            self.left = run.collection.rescued() if run.keeps else None
            self.charts = TrainingCharts(view.charts)
            settings = RunSettings(view.kind.presets[view.preset], 0, partial(run.ask, "change"), self.begin, view.kind)
            self.knobs = KnobsPanel(self.form, settings)
            self.view = view(self)
            self._look()
            self.build()
            self.form.focus(self.start_button)
            self.lay_out()
        except BaseException:  # nobody closes a scene that could not be built
            self.close()
            raise
        if resume:
            self.start(self.knobs.config, 0, resume)

    # What the player opens

    def opened(self, name: str) -> bool:
        """Whether a part is open."""
        return self._settings.is_open(name)

    def open(self, name: str) -> None:
        """Open a part, or close it; it stays so for this player."""
        self.context.unfold(name)

    def switch(self, column: Column, name: str, words: tuple[str, str], help_: str = "") -> None:
        """Add the word that opens a part, or closes it."""
        column.button(words[self.opened(name)], partial(self.open, name)).pad = 3.0
        column.explain(help_)

    # Rows

    def build(self) -> None:
        page, self._page = self._page, self._shown_page
        if page != self._page:
            self.panel = Panel(self.form)
        super().build()
        if page != self._page and self.panel.widgets:  # from its top
            self.form.focus(self.panel.widgets[0])

    def add_rows(self) -> None:
        self.knobs.form, self._layout = self.form, None
        self.panel = Panel(self.form, self.panel)
        self._foot = self.panel if self._low else Panel(self.form)
        self._pointed = self.view.pointers()
        for widget, _ in self._pointed:
            self.form.add(widget)
        self._describe(self.panel)
        self._describe_foot(self._foot)

    @property
    def _shown_page(self) -> Hashable:
        """Which page the panel shows."""
        return self.view.page or self.knobs.page

    @property
    def _room(self) -> pygame.FRect:
        """Room of the panel, with its foot."""
        return layout(self.context.reading().view, 1).panel.inflate(-2 * _MARGIN, -2 * 20.0)

    @property
    def _low(self) -> bool:
        """Whether there is so little room that all rows scroll, those of the foot too."""
        return self._room.height < _LOW

    def state(self) -> Hashable:
        run = self.run
        return (
            self._settings.opened, self.knobs.key, self.view.key, bool(run.problem), run.alive, run.stopping,
            bool(self.view.unfinished), self._low,
        )  # fmt: skip

    def _describe(self, column: Column) -> None:
        """Add the rows of the panel."""
        view = self.view
        view.describe_first(column)
        if view.page:
            view.describe_page(column)
        elif self.knobs.page:
            self.knobs.describe_page(column)
        else:
            self.knobs.describe(column)
            column.gap()
            self.switch(column, MORE, texts.MORE)
            if self.opened(MORE):
                self._describe_more(column)
            view.describe_last(column)

    def _describe_more(self, column: Column) -> None:
        helps = texts.TRAIN_HELP
        self.view.describe_more(column)
        if len(self.view.charts) > FEW_CHARTS:
            self.switch(column, CHARTS, texts.TRAIN_MORE_CHARTS, helps["charts"])
        for word, press, name in (
            (texts.TRAIN_MORE_KNOBS, self.knobs.open, "knobs"),
            (texts.TRAIN_SAVE, self._save, "save"),
        ):
            column.button(word, press).pad = 3.0
            column.explain(helps[name])

    def _describe_foot(self, column: Column) -> None:
        """Add what went wrong, or a hint, or help; the run that can go on; and the words that start."""
        if self.run.problem:
            column.text(lambda: self.run.problem, size=SMALL, colour=HUMAN)
        elif not self.view.describe_hint(column):
            self.knobs.describe_foot(column)
        if words := self.view.unfinished:
            column.button(texts.TRAIN_GO_ON, self._go_on_with_last, words, colour=HUMAN)
        column.gap()
        anew = [(texts.TRAIN_ANEW, self.knobs.apply)] if self.knobs.settings.running and not self.run.stopping else []
        undo = [(texts.KNOBS_UNDO, self.knobs.undo)] if self.knobs.asks else []
        self.start_button, *others = column.words([(self._start_label, self._toggle), *anew, *undo], TITLE, INK)
        for each in (self.start_button, *others):
            each.pad = 2.0
        self.view.describe_foot(column)

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
            self.view.place(place)
            for widget, box in self._pointed:
                widget.relative_rect = widget.rect = pygame.Rect(box())
        room = self._room
        height = 0.0
        if self._foot is not self.panel:
            self._foot.lay_out(pygame.FRect(room.left, room.top, room.width, _FOOT * room.height), canvas.scale)
            height = min(self._foot.height, _FOOT * room.height)
            below = pygame.FRect(room.left, room.bottom - height, room.width, height + 1)
            self._foot.lay_out(below, canvas.scale)
            height += 10
        self.panel.lay_out(pygame.FRect(room.topleft, (room.width, room.height - height)), canvas.scale)

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
        back = texts.HINT_BACK if self.view.moment is None else texts.REWIND_BACK
        return [self.form.goes_back(back), Action(Command.HANDOVER, self._toggle), self.explained.action()]

    def hint_rows(self, canvas: Canvas) -> Sequence[HintRow]:
        return [hint_row(self._layout, self.hints[:1])] if self._layout else []

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Go on explaining; scroll the panel by the wheel; everything else is the view's and the form's."""
        if self.explained.handle_event(event):
            return None
        if not self.view.fills:
            self.charts.follow(event)
        self.view.follow(event)
        outcome = super().handle_event(event)
        over = self._layout is not None and self._layout.panel.collidepoint(self.form.manager.mouse_position)
        if event.type == pygame.MOUSEWHEEL and not self.form.used and over:
            self.form.used = self.panel.turn_wheel(event.y)
        if not self.form.used:
            self.view.follow_unused(event)
        return outcome

    def update(self) -> Transition | None:
        """Receive the worker's messages, look at the run now and then, and animate the screen."""
        self._listen()
        outcome = self.view.update()
        self._frame += 1
        self._look()
        self.explained.update()
        return super().update() or outcome

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
            self.knobs.set_running(run.alive)
        if in_force := run.in_force:
            self.knobs.show_in_force(in_force)
        self.start_button.label = self._start_label

    def _look(self) -> None:
        """Look at the run: all that is said of it until the next look is read here, at once."""
        history, view = self.run.history, self.view
        beside = view.beside
        urgent = view.moment, [(each.name, each.style) for each in beside.runs], self.run.state, self.charts.charts
        if self._frame % _LOOKS and self._seen == urgent:
            self.charts.go_on()
            return
        self._seen = urgent
        self.charts.take(history, beside, view.caption(), view.moment)
        self.landed = self.charts.latest
        self.status = view.status()

    @property
    def _start_label(self) -> str:
        """What the button says that starts, pauses and resumes the run."""
        if self.run.state in (WorkerState.RUNNING, WorkerState.STARTING):
            return texts.TRAIN_PAUSE
        return texts.TRAIN_RESUME if self.run.state is WorkerState.PAUSED else texts.TRAIN_START

    # The run

    def _toggle(self) -> None:
        run = self.run
        if run.stopping:
            return
        if run.state is WorkerState.PAUSED:
            run.resume()
        elif run.alive:
            run.pause()
        else:
            self.begin(self.knobs.config, self.knobs.seed)

    def begin(self, config: Any, seed: int) -> None:
        """Start a run; one that has learnt and has no name is put among the player's networks."""
        if not self.view.worth_keeping or self._keep():
            self.start(config, seed)

    def _keep(self) -> bool:
        """Put the run among the player's networks under a free name; False, and a note, if that failed."""
        runs = self.run.collection
        if problem := self._save_as(runs.free_name(self.view.suggestion if self.run.runs else runs.rescued_name)):
            self.context.note(problem)
        return not problem

    def instead(self, start: Callable[[], None]) -> Transition | None:
        """Start something in place of the run; ask first what becomes of one that has learnt and has no name."""
        if not self.view.worth_keeping:
            start()
            return None
        answers: list[tuple[str, Callable[[], None]]] = [
            (texts.TRAIN_KEEP_FIRST, lambda: start() if self._keep() else None),
            (texts.TRAIN_LET_GO, start),
            (texts.TRAIN_STAY, lambda: None),
        ]
        return Push(QuestionDialog(self, texts.TRAIN_TAKES_PLACE, "", answers))

    def start(self, config: Any, seed: int, resume: Path | None = None) -> None:
        """Start a run, or go on with the saved one `resume`, whose first message brings its real settings."""
        if note := self.run.begin(config, seed, resume=resume, name=self.knobs.name):
            self.context.note(note)
        self.cleared()
        if not resume:
            self.knobs.set_config(config, seed)

    def cleared(self) -> None:
        """Show nothing of the runs before."""
        self._was_running, self._seen = False, None
        self.view.clear()

    def _go_on_with_last(self) -> None:
        self.start(self.knobs.config, self.knobs.seed, self.run.collection.unsaved)

    def _save(self) -> Transition | None:
        """Ask for a name to save the run under."""
        if not (self.run.alive or self.run.kept):
            self.context.note(texts.TRAIN_NOTHING)
            return None
        return Push(NameDialog(self, texts.NAMING, self.run.collection.free_name(self.view.suggestion), self._save_as))

    def _save_as(self, name: str) -> str:
        """Save the run under a name; return why that failed, or ""."""
        try:
            if note := self.run.save(name):
                self.context.note(note)
        except LibraryError as error:
            return str(error)
        return ""

    def set_pace(self, index: int) -> None:
        """Choose one of `PACES`, for later runs too."""
        self.run.set_pace(index)
        self._settings.slow_runs = index == 0
        self.context.apply_settings()

    def take_pace(self) -> None:
        """Go as the last run of the player went."""
        self.run.set_pace(0 if self._settings.slow_runs else len(PACES) - 1)

    def _back(self) -> Transition | None:
        """Go back within the panel or the view; or leave, and if the run has learnt anything, say that it is kept."""
        if self.view.back():
            return None
        if self.knobs.page:
            self.knobs.close()
            return None
        if self.run.keeps and self.run.alive and len(self.run.history):
            self.context.note(texts.TRAIN_KEPT)
        return Pop()

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw what is seen of the run, and the panel beside it."""
        assert self._layout is not None
        display, box = self._layout.display, self._layout.swarm
        self.view.draw(canvas, alpha)
        if not self.view.fills:
            canvas.fill(canvas.rect(display.left, box.bottom, display.width, display.bottom - box.bottom), NIGHT0)
            self.charts.draw(canvas)
            canvas.line((box.left, box.bottom), (box.right, box.bottom), LINE)
            if self.view.titled:
                self.draw_title(canvas)
        canvas.fill(canvas.rect(*self._layout.panel), PANEL)
        self.panel.draw(canvas)
        if self._foot is not self.panel:
            self._foot.draw(canvas)
        self.form.draw(canvas)
        self.explained.draw(canvas)

    def draw_title(self, canvas: Canvas) -> None:
        """Draw what the run has come to, over the display."""
        assert self._layout is not None
        self.status.draw(canvas, self._layout)
        if not is_low(self._layout):
            self.draw_hints(canvas)
