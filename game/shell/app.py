"""Application: the window and the main loop of events, fixed steps of 1/60 s, and frames."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Sequence
from datetime import datetime
from io import BytesIO
from logging.handlers import RotatingFileHandler
from pathlib import Path
from typing import TYPE_CHECKING, Final

import pygame

from ai.files.writing import free_path, write_bytes
from game.core import texts
from game.core.clock import FixedStep
from game.core.scene import Push, Route
from game.core.settings import SettingsWriter
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import paint_on
from game.drawing.tokens import COLOUR_SAFE, PALETTE, TEXT_SIZES
from game.flight.friend import arrival
from game.input.controls import Command, copies_or_pastes, translate, unmapped
from game.shell.scene_manager import SceneManager
from game.shell.window import GameWindow
from game.ui.notes import Note
from game.ui.switch_scan import SwitchScan

if TYPE_CHECKING:
    from game.core.scene import Scene
    from game.ui.context import Context

LOG_NAME: Final = "tranquility.log"
_STEADY: Final = 0.1  # seconds of constant size before a redraw: a landscape takes too long to paint while resizing
_MOUSE: Final = (pygame.MOUSEMOTION, pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP)
_log = logging.getLogger("tranquility")


class App:
    """Application of the game. `run` plays it to the end; `tick` runs one frame.

    Args:
        context: the shared services; its `note` and `apply_settings` are bound to this window.
        first: route of the first scene, by default the menu's, or a function that builds the scene.
        scene_of: builds the scene of a route; `game.scenes.scene_of`.
        now: clock that returns seconds.
        capped: whether the frame rate is limited to the screen's.

    Attributes:
        notes: the note over all scenes.
        scan: what marks one choice after the other for those who play with one switch.
        canvas: canvas of the window.
        scenes: stack of scenes.

    Raises:
        NoDisplayError: no window can be opened.

    """

    def __init__(
        self,
        context: Context,
        first: Route | Callable[[Context], Scene] | None = None,
        *,
        scene_of: Callable[[Route, Context], Scene],
        now: Callable[[], float] = time.perf_counter,
        capped: bool = True,
    ) -> None:
        self.context = context
        self._now, self._capped = now, capped
        self._clock = pygame.time.Clock()
        self._buttons: set[int] = set()  # of the mouse, that are held
        self._takes_text: bool | None = None  # whether letters are composed; None before the first frame
        self._steps = FixedStep()
        self.notes = Note()
        self.scan = SwitchScan(context)
        self._mouse: tuple[tuple[int, int], ...] = ()  # the mouse's last position, in the window and on the desktop
        self._redraw_at = 0.0  # time at which the window has kept its size long enough for a redraw
        self.settings_writer = SettingsWriter(context.settings_file, context.settings)
        self.window = GameWindow(context.settings.full_screen)
        self.canvas = Canvas(self.window.surface)
        self._follow_window()
        context.note = self.notes.show
        context.apply_settings = self.apply_settings
        context.reading = lambda: self.canvas.reading
        self._look()
        context.sound.follow(context.settings)
        context.controls.follow(context.settings)
        self._start_gamepads()
        self.scenes = SceneManager(context, lambda: self.canvas.surface, scene_of)
        self.show(first or Route("menu"))
        self._last = now()

    def show(self, scene: Route | Callable[[Context], Scene]) -> None:
        """Build a scene and push it; if it cannot be built, the error screen is shown as for any other failure."""
        self._guarded(lambda: self.scenes.apply(Push(scene if isinstance(scene, Route) else scene(self.context))))

    def run(self, stop: Sequence[int] = (), max_frames: int | None = None) -> int:
        """Play until the game is closed, `stop` has an entry, or for `max_frames`. Return the process's exit code."""
        try:
            frame = 0
            while (max_frames is None or frame < max_frames) and not stop and self.tick():
                frame += 1
        finally:
            self.close()
        return 0

    def tick(self) -> bool:
        """Run one frame: events, the steps that are due, drawing. Return False once the game is closed."""
        for event in pygame.event.get():
            self._handle(event)
        self._take_text()
        time_now = self._now()
        steps = self._steps.advance(time_now - self._last)
        self._last = time_now
        for _ in range(steps):
            self.notes.update()
            self.canvas.message = self.notes.box(self.canvas.reading)
            if problem := self.settings_writer.problem():
                self.notes.show(problem)
            self._guarded(self.scenes.update)
            self._guarded(lambda: self.scenes.apply(self.scan.update(self.scenes.top, self.canvas)))
            self.context.sound.update()
            if self.context.film and (said := self.context.film.follow()):
                self.context.film = None
                self.notes.show(said)
        if self.scenes.running and not self.window.minimised and time_now >= self._redraw_at:
            self.draw()
            self._guarded(paint_on)
        if self._capped:
            self._clock.tick(self._frame_rate)
        return self.scenes.running

    def _take_text(self) -> None:
        """Have letters composed while a line of text takes them, and at no other time."""
        wanted = self.context.controls.spelling
        if wanted is not self._takes_text:
            self._takes_text = wanted
            pygame.key.start_text_input() if wanted else pygame.key.stop_text_input()

    def close(self) -> None:
        """Leave the top scene, save the settings and close the window."""
        try:
            self.scenes.close()
        except Exception:
            _log.exception("leaving the last scene")
        self.settings_writer.close(self.context.settings)
        if self.context.pilot:
            self.context.pilot.close()
        if self.context.film:
            self.context.film.close()
        self.context.sound.close()
        self.window.close()

    # The window

    def _start_gamepads(self) -> None:
        from pygame._sdl2 import controller

        try:
            controller.init()  # gamepads already plugged in are announced by events
        except pygame.error:
            _log.exception("no gamepads")

    def _follow_window(self) -> None:
        """Attach the canvas to the window's present size."""
        self.canvas.attach(self.window.surface)
        self._attached_size = self.window.size
        self._frame_rate = self.window.frame_rate

    def _look(self) -> None:
        """Apply the player's palette and size of text."""
        self.canvas.palette = COLOUR_SAFE if self.context.settings.colour_safe else PALETTE
        self.canvas.zoom = TEXT_SIZES.get(self.context.settings.text_size, 1.0)

    def apply_settings(self) -> None:
        """Apply the settings to the window and the sound, and save them."""
        if self.window.full_screen != self.context.settings.full_screen:
            self.window.full_screen = self.context.settings.full_screen
            self._follow_window()
        self._look()
        if texts.choose(self.context.settings.language):
            typeface.forget()
            for scene in self.scenes.stack:
                scene.reword()
        self.context.sound.follow(self.context.settings)
        self.settings_writer.save(self.context.settings)

    # Events

    def _handle(self, event: pygame.event.Event) -> None:
        if event.type == pygame.MOUSEMOTION:
            if not self._moved(event):
                return
            self._let_go(event)
        self._follow(event)
        self.context.sound.handle_event(event)
        match event.type:
            case pygame.QUIT:
                self.scenes.running = False
            case pygame.WINDOWMINIMIZED:
                self.window.minimised = True
                self._frame_rate = self.window.frame_rate
            case pygame.WINDOWRESTORED | pygame.WINDOWSHOWN | pygame.WINDOWMAXIMIZED:
                self.window.minimised = False
                self._follow_window()
            case pygame.WINDOWSIZECHANGED | pygame.WINDOWDISPLAYCHANGED:
                if self.window.size != self._attached_size:
                    self.window.stay_legible()
                    self._follow_window()
                    self._redraw_at = self._last + _STEADY
        if not self.scenes.running:
            return
        if event.type in _MOUSE:
            self.canvas.pointer = self.canvas.points(event.pos)
            event = self._in_points(event)
        elif not self.context.controls.mouse_in_use:
            self.canvas.pointer = None
        self._obey(event)

    def _obey(self, event: pygame.event.Event) -> None:
        """Do what an event asks of the whole game, or pass it on to a scene."""
        if self.notes.take(event, self.canvas.reading):
            return
        if event.type == pygame.KEYDOWN and event.chord and not self._means(event):
            return
        match translate(event):
            case Command.FULLSCREEN | Command.MUTE as command:
                toggle = self.context.toggle_mute if command is Command.MUTE else self.context.toggle_full_screen
                toggle()
            case Command.SCREENSHOT:
                self._save_screenshot()
            case _:
                self._guarded(lambda: self._pass_on(event))

    def _means(self, event: pygame.event.Event) -> bool:
        """Whether a key with Ctrl, Alt or the system key means anything: Alt+Enter, Ctrl+C, Ctrl+V, or in a text."""
        return translate(event) is not None or bool(copies_or_pastes(event)) or self.context.controls.spelling

    def _let_go(self, event: pygame.event.Event) -> None:
        """Let go of mouse buttons whose release was not heard, as a movement of the mouse tells."""
        held = {number for number, down in enumerate(getattr(event, "buttons", ()), 1) if down}
        for button in sorted(self._buttons - held) if hasattr(event, "buttons") else ():
            self._handle(pygame.event.Event(pygame.MOUSEBUTTONUP, pos=event.pos, button=button))

    def _moved(self, event: pygame.event.Event) -> bool:
        """Whether the mouse moved, and not the window below it."""
        (x, y), (left, top) = event.pos, self.window.position
        before, self._mouse = self._mouse, ((x, y), (x + left, y + top))
        return all(now != then for now, then in zip(self._mouse, before, strict=False))

    def _follow(self, event: pygame.event.Event) -> None:
        controls = self.context.controls
        used_mouse = controls.mouse_in_use
        controls.process(event)
        if event.type == pygame.MOUSEBUTTONDOWN:
            self._buttons.add(event.button)
        elif event.type == pygame.MOUSEBUTTONUP:
            self._buttons.discard(event.button)
        if event.type == pygame.CONTROLLERDEVICEADDED and controls.gamepad_name:
            self.notes.show(texts.PAD_FOUND.format(name=controls.gamepad_name))
        elif event.type == pygame.JOYDEVICEADDED and unmapped(event.device_index):
            self.notes.show(texts.PAD_UNKNOWN)
        elif translate(event) is Command.UNPLUGGED:
            self.notes.show(texts.PAD_LOST)
        if controls.mouse_in_use != used_mouse:
            pygame.mouse.set_visible(controls.mouse_in_use)

    def _pass_on(self, event: pygame.event.Event) -> None:
        """Run the hint that is clicked, open a friend's flight, or pass the event to the top scene."""
        chosen, transition = self.scan.take(event, self.scenes.top, self.canvas)
        if chosen:
            self.scenes.apply(transition)
            return
        if page := arrival(event, self.scenes.top, self.context):
            self.scenes.apply(page)
            return
        self.scenes.handle_event(event)

    def _in_points(self, event: pygame.event.Event) -> pygame.event.Event:
        canvas = self.canvas.reading
        values = {**event.dict, "pos": canvas.points(event.pos)}
        if event.type == pygame.MOUSEMOTION:
            values["rel"] = (event.rel[0] / canvas.scale, event.rel[1] / canvas.scale)
        return pygame.event.Event(event.type, values)

    # Drawing

    def draw(self) -> None:
        """Draw one frame: the scenes, and the note over them."""
        self.canvas.explained.clear()
        self._guarded(lambda: self.scenes.draw(self.canvas, self._steps.alpha))
        self._guarded(lambda: self.scan.draw(self.scenes.top, self.canvas))
        self.notes.draw(self.canvas.reading)
        self.window.flip()

    def _save_screenshot(self) -> None:
        """Save a screenshot, whole or not at all."""
        path = free_path(self.context.user_dir / "screenshots", f"{datetime.now():%Y-%m-%d %H.%M.%S.%f}", ".png")
        try:
            picture = BytesIO()  # pygame itself does not report a full disk
            pygame.image.save(self.canvas.surface, picture, path.name)
            write_bytes(path, picture.getvalue(), flush=False)
        except OSError as error:
            self.notes.show(texts.SCREENSHOT_FAILED.format(reason=error.strerror or error))
        except pygame.error as error:
            self.notes.show(texts.SCREENSHOT_FAILED.format(reason=error))
        else:
            self.notes.show(texts.SCREENSHOT_SAVED.format(path=path))

    # Faults

    def _guarded(self, call: Callable[[], object]) -> None:
        """Call a scene's code; on an exception, log it and show the error screen, which leads to the menu."""
        try:
            call()
        except Exception as error:
            _log.exception("in %s", self.scenes.description)
            self.canvas.surface.set_clip(None)
            self.scenes.reset(Route("error_screen", (error, self.context.user_dir / LOG_NAME)))


def log_to(folder: Path) -> None:
    """Log errors to a file in the player's folder; if it cannot be written, go on without."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handler = RotatingFileHandler(folder / LOG_NAME, maxBytes=500_000, backupCount=1, delay=True)
    except OSError:
        return
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(name)s: %(message)s"))
    _log.addHandler(handler)
    _log.propagate = False
