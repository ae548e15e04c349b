"""Plays the game in a test: real pygame events in, frames on."""

import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing import active_children
from typing import Any, TypeVar

import pygame

from game.core import texts
from game.core.settings import FILE_NAME
from game.shell.app import App
from game.ui.form import Form
from game.ui.rows import ChoiceRow

Kind = TypeVar("Kind")


class Driver:
    """Plays one game.

    Attributes:
        unseen: whether no frame is drawn at all until somebody looks again.

    """

    def __init__(self, app: App) -> None:
        self.app = app
        self.unseen = False
        self._skipped = 0
        self._held: set[int] = set()  # buttons of the mouse

    @property
    def top(self) -> Any:
        """The scene on the screen; which class it is, the test knows."""
        return self.app.scenes.top

    @property
    def top_name(self) -> str:
        return type(self.top).__name__

    @property
    def said(self) -> str:
        """What the note over all scenes says, or said last."""
        return self.app.notes.text

    @property
    def form(self) -> Form:
        """The widgets of the scene on the screen."""
        form = getattr(self.top, "form", None)
        assert isinstance(form, Form)
        return form

    def frames(self, number: int = 1) -> bool:
        """Play frames. The first, the last and each thirtieth are drawn: that is most of the work, and changes nothing.

        Events come in with the first frame, which may hide or show the window.
        """
        for left in reversed(range(number)):
            goes_on = self._play(drawn=left in (0, number - 1) or left % 30 == 0)
        return goes_on

    def skip(self, number: int = 1) -> None:
        """Play frames of which only every thirtieth is drawn, of many calls too."""
        for _ in range(number):
            self._skipped += 1
            self._play(drawn=self._skipped % 30 == 0)

    def _play(self, *, drawn: bool) -> bool:
        window = self.app.window
        if (drawn and not self.unseen) or window.minimised:
            return self.app.tick()
        window.minimised = True
        goes_on = self.app.tick()
        window.minimised = False
        return goes_on

    def wait(self, until: Callable[[], object], seconds: float = 60.0) -> None:
        """Play frames until something holds, few of them drawn; the limit is only there so that a failure ends."""
        end = time.monotonic() + seconds
        while not until():
            assert time.monotonic() < end, "it never happened"
            self.skip()
            time.sleep(0.005 if active_children() else 0.001)  # a process needs the time, a thread a little

    def post(self, event_type: int, *, drawn: bool = True, **values: Any) -> bool:
        """Let an event come in with a frame."""
        if event_type == pygame.MOUSEBUTTONDOWN:
            self._held.add(values["button"])
        elif event_type == pygame.MOUSEBUTTONUP:
            self._held.discard(values["button"])
        pygame.event.post(pygame.event.Event(event_type, values))
        return self._play(drawn=drawn)

    def key(self, key: int, mod: int = 0, *, drawn: bool = True) -> bool:
        """Press a key, and let go of it in the next frame, which is drawn."""
        self.post(pygame.KEYDOWN, drawn=False, key=key, mod=mod, unicode="", scancode=0)
        return self.post(pygame.KEYUP, drawn=drawn, key=key, mod=mod, unicode="", scancode=0)

    def keys(self, *keys: int) -> None:
        """Press keys one after another; the last frame is drawn."""
        for left, key in zip(reversed(range(len(keys))), keys, strict=True):
            self.key(key, drawn=not left)

    def button(self, button: int, pad: int = 0) -> None:
        self.post(pygame.CONTROLLERBUTTONDOWN, drawn=False, instance_id=pad, button=button)
        self.post(pygame.CONTROLLERBUTTONUP, instance_id=pad, button=button)

    def axis(self, axis: int, value: int, pad: int = 0) -> None:
        self.post(pygame.CONTROLLERAXISMOTION, instance_id=pad, axis=axis, value=value)

    def to_window(self, points: tuple[float, float]) -> tuple[int, int]:
        canvas = self.app.canvas.reading
        x, y = (round(p * canvas.scale + o) for p, o in zip(points, canvas.origin, strict=True))
        return x, y

    def move(self, points: tuple[float, float]) -> None:
        buttons = tuple(int(button in self._held) for button in (1, 2, 3))
        self.post(pygame.MOUSEMOTION, pos=self.to_window(points), rel=(0, 0), buttons=buttons)

    def click(self, points: tuple[float, float]) -> None:
        self.move(points)
        self.post(pygame.MOUSEBUTTONDOWN, drawn=False, pos=self.to_window(points), button=1)
        self.post(pygame.MOUSEBUTTONUP, pos=self.to_window(points), button=1)

    def saved(self) -> dict[str, Any]:
        """The settings on the disk, once all of them are written."""
        self.app.settings_writer.wait()
        values: dict[str, Any] = json.loads((self.app.context.user_dir / FILE_NAME).read_text())
        return values

    def widget(self, label: str) -> Any:
        """The widget of that label on the screen."""
        return next(widget for widget in self.form.widgets if widget.label == label)

    def the(self, kind: type[Kind]) -> Kind:
        """The only widget of its kind on the screen."""
        [found] = [widget for widget in self.form.widgets if type(widget) is kind]
        return found

    def choice(self, option: str) -> ChoiceRow:
        """The choice on the screen that offers an option."""
        return next(each for each in self.form.widgets if isinstance(each, ChoiceRow) and option in each.options)

    def press_on(self, label: str) -> None:
        """Move the focus to the widget of that label, and press it."""
        self.form.focus(self.widget(label))
        self.key(pygame.K_RETURN)

    def hints(self) -> dict[str, tuple[float, float]]:
        """What the hints on the screen say, and where each can be clicked."""
        canvas = self.app.canvas.reading
        return {
            hint.meaning: box.center
            for row in self.top.hint_rows(canvas)
            for hint, box in zip(row.hints, row.boxes(canvas), strict=True)
            if hint.run
        }

    def write_in(self, text_size: str) -> None:
        """Change the size of text, as the settings do while a scene is open."""
        self.app.context.settings.text_size = text_size
        self.app.apply_settings()

    def resize(self, size: tuple[int, int]) -> None:
        self.app.window.size = size
        self.frames(10)  # until the window has kept its size

    @contextmanager
    def speaking(self, language: str) -> Iterator[None]:
        """Speak another language meanwhile, as once it was chosen in the settings over the scene."""
        before = texts.LANGUAGE
        try:
            self._speak(language)
            yield
        finally:
            self._speak(before)

    def _speak(self, language: str) -> None:
        self.app.context.settings.language = language
        self.app.apply_settings()
        self.frames(2)
