"""Train scene: a swarm learns to land in a process of its own; its charts are live, and so are the knobs."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Final

import pygame

from ai.training.checkpoints import agent_of
from game.core import texts
from game.core.scene import Pop, Transition, push
from game.core.worker import WorkerState
from game.drawing.canvas import Canvas
from game.drawing.tokens import LINE, NIGHT0, VIEW_SIZE
from game.input.controls import Command
from game.lesson.door import LessonDoor
from game.panels.advice import Advice
from game.panels.chart_captions import ChartCaptions
from game.panels.explained import Explained
from game.panels.network_panel import NetworkPanel
from game.panels.rewind import Rewind
from game.panels.run_status import draw_run_status
from game.panels.training_charts import PAID, TrainingCharts
from game.panels.training_status import lander_status
from game.scenes.split_scene import SplitTrainingScene
from game.scenes.train_dialogs import TrainDialogs
from game.scenes.training_scene import DISPLAY_WIDTH, LEFT
from game.training.library import Library
from game.training.run import TrainingRun
from game.training.workers import LANDERS, PACES
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.hints import HintRow
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import OnPress, Widget
from game.ui.widgets import Choice, TextButton
from game.world.swarm import LearningSwarm

_FLOOR: Final = 434.0  # where the charts begin
_SAID: Final = pygame.Rect(868, 612, 384, 60)
_TITLE: Final = pygame.Rect(24, 16, 350, 124)
_COVER: Final = 0.88  # of the panels over the swarm: its landers are many, and bright
_BEHIND: Final = 0.72  # cover of the swarm behind an edited network
_WORDS: Final = pygame.Rect(684, 16, 136, 154)  # beside the swarm
_SWARM: Final = pygame.Rect(16, 176, 804, 246)  # where keys can point at a lander
_CONTROLS: Final = pygame.Rect(868, 676, 384, 28)


class TrainScene(SplitTrainingScene):
    """Train scene: swarm, charts and knobs. With `resume`, a saved run continues at once."""

    def __init__(self, context: Context, resume: Path | None = None) -> None:
        self._resume = resume
        self._compared = False
        self.library = Library(context.user_dir)
        self.lander_run = TrainingRun(LANDERS, self.library)
        super().__init__(context, self.lander_run, ((_SAID.left, _SAID.top + 17.0), 3))

    def _build(self) -> None:
        left = self.library.claim()  # the run left unnamed by the last visit
        self.swarm = LearningSwarm(DISPLAY_WIDTH / VIEW_SIZE[0])
        self.training_charts = TrainingCharts()
        self.captions = ChartCaptions()
        self.explained = Explained()
        self._beside: list[Widget] = []  # the widgets that are not in the panel
        self._add_controls()
        self.inside = NetworkPanel(self.form, self._look_closer, self.lander_run)
        self._add_knobs()
        self._dialogs = TrainDialogs(self, self.lander_run, self.library, self._ask, self._go_on)
        self.rewind = Rewind(self.form, self.lander_run, DISPLAY_WIDTH / VIEW_SIZE[0])
        self.lessons = LessonDoor(self.lander_run, lambda: self.shown_swarm, lambda: self.moment, self.context.note)
        self._advice = Advice(self.form, _SAID, self.knobs.turn, self._go_back)
        self._lay_beside()
        if self._resume:
            self._go_on(self._resume)
        elif left:
            self._question = self._dialogs.ask_what_becomes_of(left)

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Handle explanations, start, pause, step, knobs and the large network."""
        if self.explained.handle_event(event):
            return None
        if not self.inside.large:
            self.training_charts.charts.follow(event)
        self.inside.follow(event)
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1 and self.inside.covers(event.pos):
            self._look_closer()
            return None
        outcome = super().handle_event(event)
        if not self.inside.large and not self.form.used:
            self.lessons.follow(event)
        return outcome

    def actions(self) -> Table:
        """Go back; step, start or pause, and change the pace, as the buttons say."""
        return [
            *super().actions(),
            Action(Command.SLOWER, lambda: self._turn_pace(-1)),
            Action(Command.FASTER, lambda: self._turn_pace(1)),
            *([] if self.inside.large else [self.explained.action()]),
        ]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hint beside the title, which the network covers when it is large."""
        return [] if self.inside.large else [HintRow(self.hints[:1], (_TITLE.right - 16, 46), from_right=True)]

    def _turn_pace(self, direction: int) -> None:
        self._pace_choice.shift(direction)

    def update(self) -> Transition | None:
        """Receive the worker's messages, and animate the screen."""
        lander_run = self.lander_run
        looked = self._listen()
        self._follow_run()
        self._advice.hush(bool(self.knobs.waiting) or self.split_view.shown)
        if lander_run.alive:
            self.knobs.show_in_force(lander_run.in_force)
        still = self._settings.reduced_motion
        self.rewind.split = self.inside.editing.split = self.split_view.shown
        self.rewind.show_in(self.inside, self.training_charts)
        beside = self.split_view.beside
        others = self.split_view.paid_otherwise
        self.training_charts.look(
            lander_run.history, beside, self.split_view.name, self._caption, paid_otherwise=others
        )
        if bool(beside) is not self._compared and not self.inside.large:
            self._compared = bool(beside)
            self._lay_again()
        self.swarm.update(still)
        self.explained.update()
        self.split_view.update(still, self.moment)
        self.inside.update(still)
        # Tasks that take a millisecond or two take turns, one per frame.
        self.training_charts.charts.update(at_once=still, turn=not (looked or self.inside.busy))
        return self._ask_or(self.form.update()) or self.lessons.update()

    def _listen(self) -> bool:
        """Receive the worker's messages; return whether one was about the network."""
        lander_run = self.lander_run
        swarm_state, network_state, points = lander_run.swarm_state, lander_run.network_state, len(lander_run.history)
        for note in lander_run.poll():
            self.context.note(note)
        if lander_run.swarm_state is not None and lander_run.swarm_state is not swarm_state:
            self.swarm.take(lander_run.swarm_state)
        if len(lander_run.history) != points and self.moment is None:
            self.inside.pay(lander_run.history)
        if lander_run.network_state is None or lander_run.network_state is network_state:
            return False
        if self.moment is None:
            self.inside.take(lander_run.network_state, lander_run.config)
        if lander_run.alive and len(lander_run.history):
            health = self.inside.health
            self._advice.follow(lander_run.history, lander_run.config, health.dead_share, health.clipped_share)
        return True

    def _caption(self, chart: str) -> str:
        run = self.lander_run
        if chart in PAID and self.split_view.paid_otherwise:
            return texts.LAB_PAID_OTHERWISE
        return self.captions.read(chart, run.history, run.config, self._advice.hint) if run.alive else ""

    @property
    def moment(self) -> int | None:
        """Moment of the run that is shown, in decisions; None for now."""
        return self.rewind.moment

    @property
    def shown_swarm(self) -> LearningSwarm:
        """The landers of the moment that is shown."""
        return self.swarm if self.moment is None else self.rewind.swarm

    # The run

    def _clear(self) -> None:
        self.split_view.clear()
        self.swarm.clear()
        self.rewind.clear()
        self._advice.clear()
        self.training_charts.clear()
        self.captions.clear()
        self.inside.clear()

    def _clear_advice(self) -> None:
        self._advice.clear()

    def _open_runs(self) -> Transition:
        def go_on(folder: Path) -> Transition:
            self._go_on(folder)
            return Pop()

        return push("runs", train=go_on)

    def _ask(self, question: Transition) -> None:
        self._question = question

    # Checkpoints

    def _go_back(self, decisions: int) -> None:
        """Return the run to an earlier checkpoint."""
        checkpoint = self.lander_run.history.checkpoint_at(decisions)
        if checkpoint is not None:
            self.lander_run.revert(checkpoint)

    def _duel(self) -> Transition | None:
        """Fly against the checkpoint of the moment that is shown."""
        checkpoint = self.lander_run.history.checkpoint_at(math.inf if self.moment is None else self.moment)
        if checkpoint is None:
            self.context.note(texts.TRAIN_NO_CHECKPOINT)
            return None
        try:
            rival = agent_of(self.lander_run.config, checkpoint)
        except ValueError as error:
            self.context.note(str(error))
            return None
        name = texts.TRAIN_CHECKPOINT.format(seconds=checkpoint.seconds)
        return push("play", rival=rival, rival_name=name)

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the display, the panel beside it and, over both, an explanation."""
        super().draw(canvas, alpha)
        self.explained.draw(canvas)

    def _add_controls(self) -> None:
        left, top = _CONTROLS.topleft
        self.start_button = self.form.add(self._word(left, top, 60, texts.TRAIN_START, self._toggle))
        self.form.add(self._word(left + 84, top, 36, texts.TRAIN_STEP, self.lander_run.step))
        self._pace_choice = self.form.add(Choice(
            self.form.manager, (left + 144, top, 148, 28), "", texts.TRAIN_PACES, len(PACES) - 1,
            self.lander_run.set_pace, gap=14,
        ))  # fmt: skip
        self.form.add(self._word(left + 316, top, 68, texts.TRAIN_SAVE, self._save))

    def _word(self, x: float, y: float, width: float, label: str, press: OnPress) -> TextButton:
        return TextButton(self.form.manager, (x, y, width, 28), label, press)

    def _lay_beside(self, large: bool = False) -> None:
        """Add the widgets of the large network, or of the swarm and the charts."""
        beside = self.inside.place(large) + self.rewind.place(large)
        if not large:
            words = (
                (texts.TRAIN_RUNS, self._open_runs),
                (texts.TRAIN_DUEL, self._duel),
                (texts.TRAIN_COMPARE, self._dialogs.add),
                (texts.TRAIN_TEACH, self._teach),
                (texts.LESSON_WHY, self.lessons.open),
            )
            pointer = VirtualPointer(self.form.manager, _SWARM, self.lessons.follow, hold=texts.LESSON_MARK)
            beside = [pointer] + [
                self._word(_WORDS.left + 16, _WORDS.top + 7 + 28 * row, 104, *word) for row, word in enumerate(words)
            ]
            beside += self.training_charts.widgets(
                self.form.manager, self._duel, self.rewind, compared=self._compared, choose=self._dialogs.choose
            )
        self.form.replace(self._beside, beside)
        self._beside = beside

    def _lay_again(self) -> None:
        self._lay_beside(self.inside.large)

    def _look_closer(self) -> None:
        self.explained.stepping = False
        self._lay_beside(large=not self.inside.large)
        self.training_charts.charts.hover(None)

    @property
    def _back_hint(self) -> str:
        return texts.HINT_BACK if self.moment is None else texts.REWIND_BACK

    def _back(self) -> Transition | None:
        if self.inside.large:
            self._look_closer()
        elif self.moment is not None:
            self.rewind.clear()
        else:
            return super()._back()
        return None

    def _draw_display(self, canvas: Canvas, alpha: float) -> None:
        """Draw the swarm and the charts, or the ground of the large network."""
        whole, view = canvas.whole, canvas.whole.view
        if self.inside.large:
            edited = self.lander_run.edits.holds and self.moment is None  # then the swarm is seen behind the network
            if edited:
                self.swarm.draw(canvas, alpha, paused=self.lander_run.state is WorkerState.PAUSED)
            area = whole.rect(view.left, view.top, DISPLAY_WIDTH - view.left, view.height)
            whole.fill(area, NIGHT0, _BEHIND if edited else 1.0)
            return
        if self.split_view.shown:
            self.split_view.draw(canvas, alpha)
        elif self.moment is not None:
            self.rewind.swarm.draw(canvas, alpha, paused=True)
        else:
            self.swarm.draw(canvas, alpha, paused=self.lander_run.state is WorkerState.PAUSED)
        whole.fill(whole.rect(view.left, _FLOOR, DISPLAY_WIDTH - view.left, view.bottom - _FLOOR), NIGHT0)
        whole.line((view.left, _FLOOR), (DISPLAY_WIDTH, _FLOOR), LINE)
        self._draw_title(canvas)
        self.training_charts.draw(canvas)

    def _draw_panel(self, canvas: Canvas) -> None:
        self.inside.draw(canvas)
        self.rewind.draw(canvas)
        super()._draw_panel(canvas)

    def _draw_advice(self, canvas: Canvas) -> None:
        self._advice.draw(canvas)

    def _draw_title(self, canvas: Canvas) -> None:
        height = _TITLE.height if self.lander_run.measured else 66
        for box in ((*_TITLE.topleft, _TITLE.width, height), _WORDS):  # landers fly behind
            canvas.panel(box, _COVER)
        status = lander_status(self.lander_run, self.moment, self.rewind.row)
        draw_run_status(canvas, (LEFT, 46), texts.TRAIN_TITLE, *status, drop=76, room=_TITLE.width - 32)
        if self.lander_run.measured:
            canvas.explain((LEFT - 4, 54, _TITLE.width - 32, 20), texts.EXPLAIN_TRAINED)
            canvas.explain((LEFT - 4, 84, _TITLE.width - 32, 48), texts.EXPLAIN_TRAINED_LANDED)
        self.draw_hints(canvas)
