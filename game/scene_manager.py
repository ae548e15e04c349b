"""The stack of scenes, and the one place that changes it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from game.scene import Lasting, Pop, Push, Quit, Replace, Scene, Transition

if TYPE_CHECKING:
    import pygame

    from game.context import Context
    from game.ui.canvas import Canvas


class SceneManager:
    """Passes events and steps to the scene on top and applies what it returns.

    `running` turns false when a scene asks to quit or to pop the last one.
    """

    def __init__(self, context: Context, first: Scene) -> None:
        self._context = context
        self._stack: list[Scene] = []
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
        if self.running:
            self.apply(self.top.update())

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the top scene."""
        self.top.draw(canvas, alpha)

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
        """Take the top scenes away, for good."""
        self.top.exit()
        left = self._stack[-levels:]
        del self._stack[-levels:]
        _close(left)


def _close(scenes: list[Scene]) -> None:
    for scene in reversed(scenes):
        if isinstance(scene, Lasting):
            scene.close()
