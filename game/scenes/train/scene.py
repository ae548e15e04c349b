"""Train scene: a run in a process of its own, what is seen of it, its charts, and a panel of words."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import pygame

from game.core import texts
from game.core.scene import Pop, Push, Transition
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, INK, LINE, NIGHT0, PANEL, SMALL, TITLE
from game.explain.explained import Explained
from game.input.controls import Command
from game.scenes.menus.dialogs import NameDialog
from game.scenes.train import knobs
from game.scenes.train.charts import TrainingCharts
from game.scenes.train.landers import LanderView
from game.scenes.train.layout import PANEL_MARGIN, Layout, hint_row, is_low, layout
from game.training.run import PACES, TrainingRun
from game.training.run_settings import RunSettings
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.curves import BESIDE
from game.ui.form import FormScene
from game.ui.hints import HintRow
from game.ui.panel import Column, Panel

if TYPE_CHECKING:
    from pathlib import Path

    from game.scenes.train.view import View
    from game.ui.rows import ButtonRow

_FOOT: Final = 0.8  # share of the panel that its foot takes at most
_LOW: Final = 100.0, 220.0  # points of height below which the foot scrolls with the knobs, and with a page
_LOOKS: Final = 10  # frames from one look at the run to the next
MORE: Final = "more"  # what a player can open: the words for all else


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
        view, knobs, charts: what is seen of the run, what its knobs ask for, and the curves.
        landed: percent of each run that succeeds, at the last look; None before there is a number.
        start_button: the button that starts, pauses and resumes.

    """

    _foot: Panel
    start_button: ButtonRow

    def __init__(self, context: Context, view: type[View] = LanderView, resume: Path | None = None) -> None:
        super().__init__(context, self._back)
        self.run = run = TrainingRun(view.kind, view.collection(context.user_dir))
        self._settings, self._was_running, self._frame = context.settings, False, 0
        run.pace = PACES[0 if self._settings.slow_runs else -1]
        self._all_knobs = False  # whether the page of knobs is shown
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
            self.charts = TrainingCharts(view.charts)
            self.knobs = RunSettings(run, view.kind.presets[view.preset])
            self.view = view(self)
            self._look()
            self.build()
            self.form.focus(self.start_button)
            self.lay_out()
        except BaseException:  # nobody closes a scene that could not be built
            self.close()
            raise
        if resume:
            self.start(self.knobs.asked, 0, resume)

    def switch(self, column: Column, name: str, words: tuple[str, str], help_: str = "") -> None:
        """Add the word that opens a part for this player, or closes it."""
        column.button(words[self._settings.is_open(name)], partial(self.context.unfold, name)).pad = 3.0
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
        self._layout = None
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
        return self.view.page or self._all_knobs

    @property
    def _room(self) -> pygame.FRect:
        """Room of the panel, with its foot."""
        panel = self._place.panel
        return panel.inflate(-2 * PANEL_MARGIN, -2 * min(20.0, 0.07 * panel.height))

    @property
    def _place(self) -> Layout:
        return layout(self.context.reading().view, pair=self.run.twin is not None)

    @property
    def charted(self) -> bool:
        """Whether the charts are seen."""
        return not self.view.fills and bool(self._place.charts)

    @property
    def _titled(self) -> bool:
        """Whether the title is more than its figure."""
        return not self.view.fills and self.view.titled and not is_low(self._place)

    @property
    def _low(self) -> bool:
        """Whether there is so little room that all rows scroll, those of the foot too."""
        return self._room.height < _LOW[bool(self._shown_page)]

    def state(self) -> Hashable:
        run = self.run
        return (
            self._settings.opened, self._all_knobs, self.knobs.asked, self.knobs.problem, self.knobs.waits,
            self.view.key, self.view.first, bool(self.view.beside), bool(run.problem), run.alive, run.stopping,
            bool(self.view.unfinished), self._low, self.charted,
        )  # fmt: skip

    def _describe(self, column: Column) -> None:
        """Add the rows of the panel."""
        view, settings = self.view, self.knobs
        view.describe_first(column)
        if view.page:
            view.describe_page(column)
        elif self._all_knobs:
            knobs.describe_page(column, view.kind, settings, self.show_few)
        else:
            knobs.describe_few(column, view.kind, settings, view.first)
            if self.run.earlier and not self.run.twin:
                column.text(texts.TRAIN_BESIDE, size=SMALL, colour=BESIDE[0])
            column.gap()
            self.switch(column, MORE, texts.MORE)
            if self._settings.is_open(MORE):
                view.describe_more(column)
                for word, press, name in (
                    (texts.TRAIN_MORE_KNOBS, self.show_all, "knobs"),
                    (texts.TRAIN_SAVE, self._save, "save"),
                ):
                    column.button(word, press).pad = 3.0
                    column.explain(texts.TRAIN_HELP[name])

    def show_all(self) -> None:
        """Show the page of knobs."""
        self._all_knobs = True

    def show_few(self) -> None:
        """Show few knobs again."""
        self._all_knobs = False

    def _describe_foot(self, column: Column) -> None:
        """Add what went wrong, or a hint, or what the knobs ask; the run that can go on; and the words that start."""
        run, settings = self.run, self.knobs
        if run.problem:
            column.text(run.problem, size=SMALL, colour=HUMAN)
        elif not self.view.describe_hint(column) and (settings.problem or settings.waits):
            column.text(settings.problem or texts.KNOBS_STARTS_ANEW, size=SMALL, colour=HUMAN)
        if words := self.view.unfinished:
            column.button(
                texts.TRAIN_GO_ON, partial(self.start, settings.asked, 0, run.collection.unsaved), words, colour=HUMAN
            )
        if column is self.panel or not is_low(self._place):
            column.gap()
        anew = [(texts.TRAIN_ANEW, self._begin)] if run.alive and not run.stopping else []
        undo = [(texts.KNOBS_UNDO, settings.undo)] if settings.waits else []
        self.start_button, *others = column.words([(self._start_label, self._toggle), *anew, *undo], TITLE, INK)
        for each in (self.start_button, *others):
            each.pad = 2.0
        self.view.describe_foot(column)

    def lay_out(self) -> None:
        """Lay everything out for the window as it is."""
        canvas = self.context.reading()
        place = self._place
        if place != self._layout:
            self._layout = place
            if place.charts:
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
        return [hint_row(self._layout, self.hints[:1], titled=self._titled)] if self._layout else []

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Go on explaining; scroll the panel by the wheel; everything else is the view's and the form's."""
        if self.explained.handle_event(event):
            return None
        if self.charted:
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
        """Receive the worker's messages; show the run's settings once it tells them."""
        run = self.run
        for note in run.poll():
            self.context.note(note)
        if run.begun:  # of one that goes on, its settings are known only now
            run.begun = False
            self.knobs.ask(run.config)
        self.start_button.label = self._start_label

    def _look(self) -> None:
        """Look at the run: all that is said of it until the next look is read here, at once."""
        view, beside = self.view, self.view.beside
        urgent = view.moment, beside and beside.name, self.run.state
        if self._frame % _LOOKS and self._seen == urgent:
            return
        self._seen = urgent
        self.charts.take(self.run.history, beside, view.caption(), view.moment)
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
            self._begin()

    def _begin(self) -> None:
        """Start a run; one that has learnt and has no name is kept."""
        if self.keep():
            self.start(self.knobs.asked, self.run.seed)

    def keep(self) -> bool:
        """Put a run that has learnt and has no name among the player's networks; False, and a note, if that failed."""
        if not self.view.worth_keeping:
            return True
        if problem := self.run.save(self._free_name):
            self.context.note(problem)
        return not problem

    @property
    def _free_name(self) -> str:
        """A name for the run, after its settings; for one that was left, that of its kind."""
        runs, (preset, _) = self.run.collection, self.view.kind.words()[self.knobs.preset]
        return runs.free_name(runs.rescued_name if self.run.state is None else texts.TRAIN_NAME.format(preset=preset))

    def start(self, config: Any, seed: int, resume: Path | None = None) -> None:
        """Start a run, or go on with the saved one `resume`, whose first message brings its real settings."""
        self.run.begin(config, seed, resume)
        self.cleared()

    def cleared(self) -> None:
        """Show nothing of the runs before."""
        self._was_running, self._seen = False, None
        self.view.clear()

    def _save(self) -> Transition | None:
        """Ask for a name to save the run under."""
        if not (self.run.alive or self.run.kept):
            self.context.note(texts.TRAIN_NOTHING)
            return None
        return Push(NameDialog(self, texts.NAMING, self._free_name, self.run.save))

    def set_pace(self, index: int) -> None:
        """Choose one of `PACES`, for later runs too."""
        self.run.set_pace(PACES[index])
        self._settings.slow_runs = index == 0
        self.context.apply_settings()

    def _back(self) -> Transition | None:
        """Go back within the panel or the view; or leave, and if the run has learnt anything, say that it is kept."""
        if self.view.back():
            return None
        if self._all_knobs:
            self.show_few()
            return None
        if self.run.keeps and self.run.alive and len(self.run.history):
            self.context.note(texts.TRAIN_KEPT)
        return Pop()

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw what is seen of the run, and the panel beside it."""
        assert self._layout is not None
        display, box = self._layout.display, self._layout.swarm
        canvas.fill(canvas.whole.surface.get_rect(), NIGHT0)  # below, a passing message takes a row
        self.view.draw(canvas, alpha)
        if not self.view.fills:
            canvas.fill(canvas.rect(display.left, box.bottom, display.width, display.bottom - box.bottom), NIGHT0)
            if self._layout.charts:
                self.charts.draw(canvas)
            canvas.line((box.left, box.bottom), (box.right, box.bottom), LINE)
            if self.view.titled:
                self.status.draw(canvas, self._layout)
        canvas.fill(canvas.rect(*self._layout.panel), PANEL)
        self.panel.draw(canvas)
        if self._foot is not self.panel:
            self._foot.draw(canvas)
        self.form.draw(canvas)
        if self._titled or self._foot is not self.panel:
            self.draw_hints(canvas)
        self.explained.draw(canvas)
