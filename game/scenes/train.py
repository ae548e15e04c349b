"""Train: a swarm learns to land in a process of its own; the window shows it, and every knob can be turned."""

from __future__ import annotations

from collections import deque
from functools import partial
from pathlib import Path
from typing import Final

import numpy as np
import pygame

from ai.agent import build_network
from ai.config import PRESETS, Config
from ai.history import PARTS, Checkpoint
from ai.inspect import dead_units
from ai.lander import ACTION_NAMES, NUM_ACTIONS, NUM_FEATURES
from ai.live import agent_of
from ai.nn import NeuralNetwork
from game import texts
from game.context import Context
from game.controls import Command, translate
from game.library import Library, LibraryError, SavedRun
from game.scene import Pop, Push, Transition
from game.student import PACES, Student
from game.ui.advice import Advice, wrapped
from game.ui.canvas import Canvas
from game.ui.chart import RUN_STYLES, Chart, Charts, Series, Tick, draw_legend
from game.ui.form import Form
from game.ui.knobs import Knobs
from game.ui.netview import NetView
from game.ui.scrubber import Scrubber
from game.ui.strip import Strip
from game.ui.tokens import FIGURE, LINE, MUTE, NIGHT0, PANEL, SMALL, TITLE, VIEW_SIZE
from game.ui.widgets import Choice, Word
from game.worker import State
from game.world.swarm import LearningSwarm

_WIDTH: Final = 836.0  # of the swarm and the charts; the panel has the rest
_LEFT: Final = 40.0
_FLOOR: Final = 434.0  # where the charts begin
_PANEL: Final = (868.0, 384.0)  # left and width of what stands in the panel
_KNOBS: Final = pygame.Rect(868, 20, 384, 404)
_NET: Final = pygame.Rect(868, 458, 384, 150)
_PAID: Final = pygame.Rect(868, 478, 384, 80)
_SAID: Final = pygame.Rect(868, 612, 384, 50)
_CONTROLS: Final = 676.0
_WITNESSES: Final = 64
_EVERY: Final = 12  # frames between two looks at the history; each chart has its turn in one of them
_CHARTS: Final = (
    ("success", (40, 456, 360, 128), (0.0, 100.0), "{:.0f}"),
    ("mean_return", (436, 456, 360, 128), None, "{:.0f}"),
    ("loss", (40, 594, 172, 112), None, "{:.3g}"),
    ("mean_q", (234, 594, 172, 112), None, "{:.2f}"),
    ("epsilon", (428, 594, 172, 112), (0.0, 1.0), "{:.2f}"),
    ("stage", (622, 594, 174, 112), (0.0, 3.0), "{:.0f}"),
)


class Train:
    """The swarm, the charts, the knobs. With `resume`, a saved run goes on at once."""

    student: Student

    def __init__(self, resume: Path | None = None) -> None:
        self._resume = resume
        self._context: Context | None = None
        self._was_running = self._alive = False
        self._frame = 0
        self._told = [-1] * len(_CHARTS)  # points of the history that each chart has
        self._left: SavedRun | None = None  # by the last visit, without a name
        self._scrub: Checkpoint | None = None
        self._net: NeuralNetwork | None = None

    def enter(self, context: Context) -> None:
        """Build the screen; after a flight against a checkpoint, the run goes on."""
        if self._context is not None:
            if self._was_running:
                self.student.resume()
            return
        self._context, self._settings = context, context.settings
        self.student = Student(Library(context.user_dir))
        self._left = self.student.library.claim()
        self.swarm = LearningSwarm(_WIDTH / VIEW_SIZE[0])
        self.charts = Charts([
            Chart(box, texts.TRAIN_CHARTS[name], limits=limits, read=partial(_written, form))
            for name, box, limits, form in _CHARTS
        ])  # fmt: skip
        self._strip = Strip(_PAID)
        self._inside = 0  # 0 for the network, 1 for what it is paid
        self._view = NetView(_NET, texts.INPUTS, ACTION_NAMES)
        self._form = Form(context, on_back=Pop)
        self._add_controls()
        self.knobs = Knobs(self._form, _KNOBS, PRESETS["modern"], 0, self._change, self._begin)
        self._advice = Advice(self._form, _SAID, self.knobs.turn, self._go_back)
        self._seen: deque[np.ndarray] = deque(maxlen=_WITNESSES)  # observations, to find the silent units by
        self._dead: float | None = None
        self._scrubber = self._form.add(Scrubber(self._form.manager, self.charts, self._scrub_to, self._duel))
        if self._resume is not None:
            self._go_on(self._resume)
            self._left = None

    def exit(self) -> None:
        """Stand still while another scene has the window."""
        self._was_running = self.student.state in (State.RUNNING, State.STARTING)
        self.student.pause()

    def close(self) -> None:
        """End the run's process."""
        if self._context is not None:
            self.student.close()
            self.student.library.release()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Start, pause, step, turn knobs, look closer."""
        if event.type == pygame.MOUSEMOTION:
            self.charts.hover(event.pos)
            self._view.hover(event.pos if self._inside == 0 else None)
            self._strip.hover(event.pos if self._inside == 1 else None)
        outcome = self._form.handle_event(event)
        if outcome is not None or self._form.used:
            return outcome
        match translate(event):
            case Command.STEP:
                self.student.step()
            case Command.SLOWER | Command.FASTER as command:
                self._pace_choice.shift(1 if command is Command.FASTER else -1)
            case Command.HANDOVER:
                self._toggle()
        return None

    def update(self) -> Transition | None:
        """Listen to the worker, and let the picture ease."""
        assert self._context is not None
        if self._left:
            return self._ask_what_becomes_of(self._left)
        before = self.student.sight, self.student.insight
        for note in self.student.poll():
            self._context.note(note)
        sight, insight = self.student.sight, self.student.insight
        if sight is not None and sight is not before[0]:
            self.swarm.take(sight)
        if insight is not None and insight is not before[1]:
            self._look_inside(insight.values, insight.gradients, insight.observation)
        if self.student.begun:
            self.student.begun = False
            self.knobs.set_config(self.student.config, self.student.seed)
        if self.student.alive != self._alive:
            self._alive = self.student.alive
            self._advice.clear()
            self.knobs.set_running(self._alive)
        still = self._settings.reduced_motion
        self._frame += 1
        self._look_at_history(self._frame % _EVERY)
        self.swarm.update(still)
        self._view.update(at_once=still)
        looks = insight is not before[1] or (self._inside == 0 and self._view.busy)
        self.charts.update(at_once=still, turn=not looks)  # what takes a millisecond or two takes turns
        self._strip.update(at_once=still)
        self._name_controls()
        return self._form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the swarm, the charts and the panel."""
        self.swarm.draw(canvas, alpha, paused=self.student.state is State.PAUSED)
        canvas.fill(canvas.rect(0, _FLOOR, _WIDTH, VIEW_SIZE[1] - _FLOOR), NIGHT0)
        canvas.line((0, _FLOOR), (_WIDTH, _FLOOR), LINE)
        canvas.fill(canvas.rect(_WIDTH, 0, VIEW_SIZE[0] - _WIDTH, VIEW_SIZE[1]), PANEL)
        self._draw_title(canvas)
        series = self._series("success")
        if len(series) > 1:
            draw_legend(canvas, series, (_LEFT, 450))
        self.charts.draw(canvas)
        (self._view, self._strip)[self._inside].draw(canvas)
        self.knobs.draw(canvas)
        self._draw_said(canvas)
        self._form.draw(canvas)

    # The run

    def _toggle(self) -> None:
        state = self.student.state
        if state is State.PAUSED:
            self.student.resume()
        elif self.student.alive:
            self.student.pause()
        else:
            self._begin(self.knobs.config, self.knobs.seed)

    def _begin(self, config: Config, seed: int, resume: Path | None = None) -> None:
        assert self._context is not None
        if note := self.student.begin(config, seed, resume):
            self._context.note(note)
        self.swarm.clear()
        self._advice.clear()
        self._seen.clear()
        self._dead = None
        self._scrub, self._net = None, None
        self._told = [-1] * len(_CHARTS)
        if resume is None:
            self.knobs.set_config(config, seed)

    def _go_on(self, folder: Path) -> None:
        """Go on with a saved run, with its own settings."""
        self._begin(Config(), 0, folder)  # its first word says what it really is made with

    def _change(self, name: str, value: object) -> None:
        self.student.change(name, value)

    def _save(self) -> Transition | None:
        from game.scenes.dialog import Naming

        assert self._context is not None
        if not self.student.kept:
            self._context.note(texts.TRAIN_NOTHING)
            return None
        suggestion = self.student.library.free_name(texts.TRAIN_NAME.format(preset=self.knobs.name))
        return Push(Naming(self, texts.TRAIN_NAMING, suggestion, self._save_as))

    def _save_as(self, name: str) -> str:
        """Save under a name; returns why it can't be called so."""
        assert self._context is not None
        try:
            if note := self.student.save(name):
                self._context.note(note)
        except LibraryError as error:
            return str(error)
        return ""

    def _open_runs(self) -> Transition:
        from game.scenes.runs import Runs

        def go_on(folder: Path) -> Transition:
            self._go_on(folder)
            return Pop()

        return Push(Runs(train=go_on))

    def _ask_what_becomes_of(self, left: SavedRun) -> Transition:
        """Offer the run that was left without a name by the last visit, or by a game that ended too early."""
        from game.scenes.dialog import Asking

        self._left = None
        more = texts.TRAIN_LEFT_YOUNG if left.success is None else texts.TRAIN_LEFT_FIGURES
        more = left.problem or more.format(seconds=left.seconds, percent=100 * (left.success or 0.0))
        answers = [(texts.TRAIN_LEFT_DISCARD, partial(self._discard, left.name))]
        if left.resumable:
            answers.insert(0, (texts.TRAIN_LEFT_GO_ON, partial(self._go_on, left.folder)))
        return Push(Asking(self, texts.TRAIN_LEFT, more, answers))

    def _discard(self, name: str) -> None:
        assert self._context is not None
        try:
            self.student.library.discard_rescued()
        except LibraryError as error:
            self._context.note(str(error))
        else:
            self._context.note(texts.RUN_DELETED.format(name=name))

    def _compare(self) -> Transition:
        """Ask for a saved run whose curves shall be seen beside these."""
        from game.scenes.dialog import Picking

        runs = self.student.library.runs()

        def put(number: int) -> None:
            assert self._context is not None
            if note := self.student.compare(runs[number].name, runs[number].folder):
                self._context.note(note)
            self._told = [-1] * len(_CHARTS)

        return Push(Picking(self, texts.TRAIN_COMPARE_WITH, [(run.name,) for run in runs], put))

    # Checkpoints

    def _go_back(self, decisions: int) -> None:
        """Let the run be what it was at its best."""
        checkpoint = self.student.history.checkpoint_at(decisions)
        if checkpoint is not None:
            self.student.revert(checkpoint)

    def _scrub_to(self, place: float | int) -> None:
        """Choose the checkpoint at so many seconds, or one further left or right for a whole -1 or 1."""
        found = self.student.history.checkpoints
        if not found:
            return
        if isinstance(place, int):
            last = found.index(self._scrub) if self._scrub in found else len(found) - 1
            self._scrub = found[min(max(last + place, 0), len(found) - 1)]
        else:
            self._scrub = min(found, key=lambda each: abs(each.seconds - place))
        caption = texts.TRAIN_CHECKPOINT.format(seconds=self._scrub.seconds)
        self.charts.mark(self._scrub.seconds, caption)

    def _duel(self) -> Transition | None:
        """Fly against the chosen checkpoint, or the latest."""
        from game.scenes.play import Play

        assert self._context is not None
        found = self.student.history.checkpoints
        checkpoint = self._scrub or (found[-1] if found else None)
        if checkpoint is None:
            self._context.note(texts.TRAIN_NO_CHECKPOINT)
            return None
        try:
            rival = agent_of(self.student.config, checkpoint)
        except ValueError as error:
            self._context.note(str(error))
            return None
        return Push(Play(rival=rival, rival_name=texts.TRAIN_RIVAL.format(seconds=checkpoint.seconds)))

    # The picture

    def _add_controls(self) -> None:
        manager, left = self._form.manager, _PANEL[0]
        y = _CONTROLS

        def word(x: float, width: float, label: str, press: object) -> Word:
            return self._form.add(Word(manager, (x, y, width, 28), label, press))  # type: ignore[arg-type]

        self._start_word = word(left, 60, texts.TRAIN_START, self._toggle)
        self._step_word = word(left + 84, 36, texts.TRAIN_STEP, self.student.step)
        self._pace_choice = self._form.add(Choice(
            manager, (left + 144, y, 148, 28), "", texts.TRAIN_PACES, len(PACES) - 1, self.student.set_pace, gap=14,
        ))  # fmt: skip
        self._save_word = word(left + 316, 68, texts.TRAIN_SAVE, self._save)
        self._form.add(Choice(
            manager, (left, 432, 384, 20), "", texts.TRAIN_INSIDE, 0, self._look_at, size=SMALL,
        ))  # fmt: skip
        y = 26
        word(_WIDTH - 136, 112, texts.TRAIN_RUNS, self._open_runs)
        y = 54
        word(_WIDTH - 136, 112, texts.TRAIN_DUEL, self._duel)
        y = 82
        word(_WIDTH - 136, 112, texts.TRAIN_COMPARE, self._compare)

    def _look_at(self, index: int) -> None:
        self._inside = index

    def _name_controls(self) -> None:
        state = self.student.state
        running = state in (State.RUNNING, State.STARTING)
        self._start_word.label = (
            texts.TRAIN_PAUSE if running else texts.TRAIN_RESUME if state is State.PAUSED else texts.TRAIN_START
        )

    def _look_inside(self, values: np.ndarray, gradients: np.ndarray, observation: np.ndarray) -> None:
        if self._net is None or self._net.values.shape != values.shape:
            self._net = build_network(NUM_FEATURES, NUM_ACTIONS, self.student.config, np.random.default_rng(0))
        if self._net.values.shape == values.shape:
            self._net.values = values
            self._net.gradients[:] = gradients
            self._view.set(self._net, observation)
            self._seen.append(observation)
            if len(self._seen) == _WITNESSES:
                self._dead = dead_units(self._net, np.array(self._seen))
                self._seen.clear()

    def _look_at_history(self, turn: int) -> None:
        """Show what is new in it: a chart in each even turn, the rest in an odd one, so that no frame has it all."""
        history = self.student.history
        if turn == 1 and len(history):
            self._strip.set(PARTS, history.parts[-1])
            if self.student.alive:
                self._advice.follow(history, self.student.config, self._dead)
        number, odd = divmod(turn, 2)
        if odd or number >= len(_CHARTS) or self._told[number] == len(history):
            return
        self._told[number] = len(history)
        runs = [history, *(old for _, old in self.student.earlier)]
        end = max([10.0, *(float(run["seconds"][-1]) for run in runs if len(run))])
        name, ticks = _CHARTS[number][0], list[Tick]()
        if name == "success":
            ticks = [Tick(each.seconds, texts.TRAIN_CHECKPOINT.format(seconds=each.seconds))
                     for each in history.checkpoints]  # fmt: skip
        self.charts.charts[number].set(self._series(name), (0.0, end), ticks)

    def _series(self, name: str) -> list[Series]:
        runs = [(texts.TRAIN_THIS, self.student.history), *self.student.earlier]
        factor = 100.0 if name == "success" else 1.0
        return [
            Series(run["seconds"], factor * run[name], title, colour, dash, smooth=name not in ("epsilon", "stage"))
            for (title, run), (colour, dash) in zip(runs, RUN_STYLES, strict=False)
            if len(run)
        ]

    def _draw_title(self, canvas: Canvas) -> None:
        canvas.text(texts.TRAIN_TITLE, (_LEFT, 46), size=TITLE)
        history, sight = self.student.history, self.student.sight
        if not len(history) or sight is None:
            canvas.text(texts.TRAIN_LINE, (_LEFT, 68), size=SMALL, colour=MUTE)
            return
        last = history.points[-1]
        line = texts.TRAIN_FIGURES.format(count=len(sight.outcome), seconds=last[0], decisions=int(sight.decisions))
        canvas.text(line, (_LEFT, 68), size=SMALL, colour=MUTE, tabular=True)
        share = f"{100 * history['success'][-1]:.0f}"
        figure = canvas.text(share, (_LEFT - 1, 122), size=FIGURE, weight="light", tabular=True,
                             colour=canvas.palette.good)  # fmt: skip
        canvas.text(texts.TRAIN_LANDED, (figure.right + 8, 122), size=SMALL, colour=MUTE)

    def _draw_said(self, canvas: Canvas) -> None:
        """Say what is wrong, or what to do first."""
        left, top = _SAID.left, _SAID.top
        if not self.student.problem:
            self._advice.draw(canvas)
        if problem := self.student.problem:
            canvas.marker("cross", (left + 5, top + 13), 10, canvas.palette.warn)
            for number, line in enumerate(wrapped(canvas, problem, SMALL, _SAID.width - 20)[:3]):
                canvas.text(line, (left + 18, top + 17 + 16 * number), size=SMALL, colour=canvas.palette.warn)


def _written(form: str, value: float) -> str:
    return form.format(value).replace("-", "−")
