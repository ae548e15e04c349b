"""The stack of scenes, and the one place that changes it."""

from __future__ import annotations

import gc
from typing import TYPE_CHECKING, Final
from weakref import ref

from game.scene import Lasting, Pop, Push, Quit, Replace, Scene, Transition

if TYPE_CHECKING:
    import pygame

    from game.context import Context
    from game.ui.canvas import Canvas


_FADE_STEPS: Final = 11  # in which the picture of a scene gives way to that of the next


class SceneManager:
    """Passes events and steps to the scene on top and applies what it returns.

    The next scene is in charge at once; only the picture of the last one lingers for a moment, unless motion is to
    be reduced. `running` turns false when a scene asks to quit or to pop the last one.
    """

    def __init__(self, context: Context, first: Scene) -> None:
        self._context = context
        self._stack: list[Scene] = []
        self._drawn: ref[Scene] | None = None
        self._lingering: pygame.Surface | None = None
        self._fade = 0
        self.running = True
        self.apply(Push(first))

    @property
    def top(self) -> Scene:
        """The scene that is seen and heard."""
        return self._stack[-1]

    def handle_event(self, event: pygame.event.Event) -> None:
        """Give one event to the top scene."""
        if self.running:
            self.apply(self.top.handle_event(event))

    def update(self) -> None:
        """Advance the top scene by one step."""
        self._fade = max(0, self._fade - 1)
        if self.running:
            self.apply(self.top.update())

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the top scene, and what is still to be seen of the one before."""
        if self._drawn is None or self.top is not self._drawn():
            moves = self._drawn is not None and not self._context.settings.reduced_motion
            self._lingering = canvas.surface.copy() if moves else None
            self._drawn, self._fade = ref(self.top), _FADE_STEPS
        self.top.draw(canvas, alpha)
        if self._fade == 0:
            self._lingering = None
        elif self._lingering and self._lingering.get_size() == canvas.surface.get_size():
            self._lingering.set_alpha(round(255 * (self._fade / (_FADE_STEPS + 1)) ** 2))
            canvas.surface.blit(self._lingering, (0, 0))

    def apply(self, transition: Transition | None) -> None:
        """Do what a scene asked for, and let it be heard."""
        if transition is not None:
            self._context.sound.play("back" if isinstance(transition, Pop) else "choose")
        match transition:
            case Push(scene):
                if self._stack:
                    self.top.exit()
                self._enter(scene)
            case Replace(scene):
                self._leave(1)
                self._enter(scene)
            case Pop(levels):
                self._pop(levels)
            case Quit():
                self.running = False

    def reset(self, *scenes: Scene) -> None:
        """Leave every scene without a word to them, for their state is in doubt, and put these in place."""
        left = [scene for scene in self._stack if scene not in scenes]
        self._stack = list(scenes[:-1])
        _close(left)
        self._enter(scenes[-1])

    def close(self) -> None:
        """Leave every scene, for good."""
        if self._stack:
            self._leave(len(self._stack))

    def _enter(self, scene: Scene) -> None:
        self._stack.append(scene)
        scene.enter(self._context)

    def _pop(self, levels: int) -> None:
        if levels >= len(self._stack):
            self.running = False  # `close` leaves the top scene
            return
        self._leave(levels)
        self.top.enter(self._context)

    def _leave(self, levels: int) -> None:
        """Take the top scenes away, for good, and with them what they hold.

        A scene and its widgets hold each other and many pictures. Collected but now and then, they came to 250 MB in
        an hour; here, between two pictures, it takes a few milliseconds.
        """
        self.top.exit()
        left = self._stack[-levels:]
        del self._stack[-levels:]
        _close(left)
        del left
        gc.collect()


def _close(scenes: list[Scene]) -> None:
    for scene in reversed(scenes):
        if isinstance(scene, Lasting):
            scene.close()
