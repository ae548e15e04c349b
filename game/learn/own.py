"""Chapter 11, your own: train a network, let it fly, hand over to it, race it; what is done ticks itself."""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable, Sequence
from contextlib import suppress
from typing import Final, NamedTuple

from ai.agent.agent import DeepQAgent
from ai.training.loop import Training
from game.core import texts
from game.core.scene import Route, Transition, push
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import FAINT, HUMAN, INK, LINE, MUTE, SMALL, TEXT, TITLE
from game.flight import networks
from game.flight.flight_file import Entry
from game.flight.logbook import Records
from game.learn.chapter import STAGE, Chapter, Code
from game.learn.progress import Progress
from game.training.library import Library, SavedRun
from game.ui.context import Context
from game.ui.widget import PointsManager, Widget
from game.ui.widgets import TextButton

STEPS: Final = ("train", "land", "choose", "hand", "race")
_LOOK: Final = 60  # updates between two looks at the player's files
_ROW: Final = 84.0


class Step(NamedTuple):
    """One step of the list: whether it is done, and what is known of it."""

    done: bool
    told: str


class OwnChapter(Chapter):
    """A list of five steps with the player's own network, read from their files; nothing to fail.

    Attributes:
        steps: the steps by their names in `STEPS`.

    """

    key = "own"
    answer = 0
    door = Route("watch")

    def __init__(self, context: Context, manager: PointsManager) -> None:
        super().__init__(context, manager)
        self._library, self._records = Library(context.user_dir), Records(context.user_dir)
        self.restart()

    def restart(self) -> None:
        """Look at the player's files again."""
        self._wait = 0
        self._seen: Hashable = None
        self._look()

    def widgets(self) -> list[Widget]:
        """Return where each step can be done."""
        doors: dict[str, Callable[[], Transition | None]] = {
            "train": lambda: push("train"),
            "land": lambda: push("runs"),
            "choose": lambda: push("runs"),
            "hand": lambda: push("play"),
            "race": self._race,
        }
        return [
            TextButton(self.manager, self.row(number), texts.LEARN_OWN_DOORS[name], doors[name])
            for number, name in enumerate(STEPS)
        ]

    def update(self) -> None:
        """Look now and then whether something has been done."""
        self._wait = (self._wait + 1) % _LOOK
        if self._wait == 0:
            self._look()

    def _race(self) -> Transition | None:
        """Race the latest of the player's networks that can be read."""
        for run in self._runs:
            policy = networks.load(run.name, run.folder).policy if run.flyable else None
            if policy is not None:
                Progress(self.context.settings).note(self.key, raced=int(time.time()) + 1)
                self.context.apply_settings()
                return push("play", rival=policy, rival_name=run.name)
        self.context.note(texts.LEARN_OWN_NONE)
        return None

    # What has been done

    def _look(self) -> None:
        """Read the player's networks, choice and logbook, if any of them has changed."""
        raced = self.context.settings.learnt.get(self.key, {})
        raced_at = raced.get("raced") if isinstance(raced, dict) else None
        seen = (self._changed(), self.context.settings.model, raced_at)
        if seen == self._seen:
            return
        self._seen = seen
        self._runs = [run for run in self._library.runs() if not run.problem or run.flyable]
        rescued = self._library.rescued()
        flown = self._records.entries()
        own = self._own_names()
        self.steps = {
            "train": self._trained(rescued),
            "land": self._landed(rescued),
            "choose": self._chosen(own),
            "hand": self._handed(own, flown),
            "race": self._raced(raced_at, flown),
        }
        self.tried = self.steps["train"].done

    def _changed(self) -> tuple[float, ...]:
        """Return what tells whether the player's files have changed: dates, and the logbook's size."""
        found: list[float] = []
        for path in (self.context.user_dir / networks.PLAYERS, self._library.unsaved, self._records.logbook):
            with suppress(OSError):
                stat = path.stat()
                found += [stat.st_mtime, stat.st_size]
        return tuple(found)

    def _own_names(self) -> set[str]:
        mine = self.context.user_dir / networks.PLAYERS
        found = networks.folders(self.context.models_dir, self.context.user_dir)
        return {name for name, folder in found.items() if folder.parent == mine}

    def _trained(self, rescued: SavedRun | None) -> Step:
        if self._runs:
            run = self._runs[0]
            told = texts.LEARN_OWN_TOLD["trained"].format(name=run.name, decisions=f"{run.decisions:,}")
            return Step(True, told)
        if rescued is not None:
            return Step(True, texts.LEARN_OWN_TOLD["unnamed"].format(decisions=f"{rescued.decisions:,}"))
        return Step(False, texts.LEARN_OWN_TOLD["untrained"])

    def _landed(self, rescued: SavedRun | None) -> Step:
        measured = [run for run in (*self._runs, *([rescued] if rescued else [])) if run.success is not None]
        if not measured:
            return Step(False, texts.LEARN_OWN_TOLD["unmeasured"])
        best = max(measured, key=lambda run: run.success or 0.0)
        key = "landed_unnamed" if best is rescued else "landed"
        told = texts.LEARN_OWN_TOLD[key].format(name=best.name, share=best.success)
        return Step(bool(best.success), told)

    def _chosen(self, own: set[str]) -> Step:
        name = self.context.settings.model
        done = name in own
        told = texts.LEARN_OWN_TOLD["chosen" if done else "shipped"]
        return Step(done, told.format(name=name or networks.DEFAULT))

    def _handed(self, own: set[str], flown: Sequence[Entry]) -> Step:
        shared = [entry for entry in flown if entry.network in own and entry.human < 1.0]
        if not shared:
            return Step(False, texts.LEARN_OWN_TOLD["alone"])
        last = shared[-1]
        told = texts.LEARN_OWN_TOLD["handed"].format(name=last.network, share=1.0 - last.human)
        return Step(True, told)

    def _raced(self, raced_at: object, flown: Sequence[Entry]) -> Step:
        done = type(raced_at) is int and any(entry.when >= raced_at for entry in flown)
        return Step(done, texts.LEARN_OWN_TOLD["raced" if done else "unraced"])

    # What it tells

    def why(self, guess: int | None) -> str:  # noqa: ARG002
        """Return how long the player's network has trained, and how it flies."""
        if not self._runs:
            return self.steps["train"].told
        run = self._runs[0]
        told = texts.LEARN_OWN_WHY.format(name=run.name, seconds=run.seconds, decisions=f"{run.decisions:,}")
        return f"{told} {self.steps['land'].told}"

    def code(self) -> Sequence[Code]:
        """Return one decision of training."""
        return [Code(Training.advance, DeepQAgent.train_step), Code(DeepQAgent.train_step), Code(DeepQAgent.learn)]

    def draw(self, canvas: Canvas, alpha: float) -> None:  # noqa: ARG002
        """Draw the list."""
        left, top = STAGE.left + 24, STAGE.top + 24
        done = sum(step.done for step in self.steps.values())
        for number, (name, step) in enumerate(self.steps.items()):
            y = top + _ROW * number
            if number:
                canvas.line((left, y - _ROW + 12), (left, y - 12), LINE)
            if step.done:
                canvas.dot((left, y), 7, canvas.palette.good)
            else:
                canvas.outline((left - 7, y - 7, 14, 14), 7, FAINT, 1.5)
            canvas.text(texts.LEARN_OWN_STEPS[name], (left + 32, y + 6), size=TITLE - 3, weight="light",
                        colour=INK if step.done else MUTE, room=STAGE.width - 60)  # fmt: skip
            draw_wrapped(canvas, step.told, (left + 32, y + 30), STAGE.width - 80, size=SMALL + 1,
                         colour=HUMAN if step.done else MUTE, leading=18, most=2)  # fmt: skip
        canvas.text(texts.LEARN_OWN_DONE.format(done=done, count=len(STEPS)), (STAGE.left, STAGE.bottom), size=TEXT,
                    colour=MUTE, room=STAGE.width)  # fmt: skip
