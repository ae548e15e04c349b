"""Scene manager: the scene stack, and the only code that changes it."""

from __future__ import annotations

import gc
import logging
from typing import TYPE_CHECKING, Final

import pygame

from ai.nn import ModelFormatError
from game.core.scene import Pop, Push, Quit, Replace, Route, Scene, Transition

if TYPE_CHECKING:
    from collections.abc import Callable

    from game.drawing.canvas import Canvas
    from game.ui.context import Context


_log = logging.getLogger("tranquility")
_FADE_STEPS: Final = 11  # length of the cross-fade between two scenes


class SceneManager:
    """Scene stack that passes events and steps to its top scene and applies the transitions it returns.

    The next scene takes over at once; only the picture of the last one fades for a moment, unless motion is to
    be reduced. `running` turns false when a scene asks to quit or to pop the last one.

    Args:
        context: the shared services for every scene.
        picture: returns the window's pixels as last drawn.
        scene_of: builds the scene of a route with the context.

    Attributes:
        stack: the scenes, the one that is seen last.

    """

    def __init__(
        self, context: Context, picture: Callable[[], pygame.Surface], scene_of: Callable[[Route, Context], Scene]
    ) -> None:
        self._context, self._picture, self._scene_of = context, picture, scene_of
        self.stack: list[Scene] = []
        self._lingering: pygame.Surface | None = None
        self._fade = 0
        self._seen = False  # whether a frame has been drawn yet
        self.running = True

    @property
    def top(self) -> Scene:
        """Scene on top of the stack, which is seen and heard."""
        return self.stack[-1]

    @property
    def description(self) -> str:
        """Description of the stack, for the log."""
        return " > ".join(type(scene).__name__ for scene in self.stack)

    def handle_event(self, event: pygame.event.Event) -> None:
        """Pass one event to the top scene."""
        if self.running:
            self.apply(self.top.handle_event(event))

    def update(self) -> None:
        """Advance the top scene by one step."""
        self._seen = True
        if self._lingering:
            self._fade -= 1
            if self._fade <= 0:
                self._lingering = None
            elif self._fade % 2:  # to dim a large window takes as long as to draw half of what is on it
                _dim(self._lingering, (self._fade / (self._fade + 2)) ** 2)
        if self.running:
            self.apply(self.top.update())

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the top scene, and the fading picture of the one before."""
        self.top.draw_on(canvas, alpha)
        if self._lingering and self._lingering.get_size() == canvas.surface.get_size():
            canvas.surface.blit(self._lingering, (0, 0), special_flags=pygame.BLEND_PREMULTIPLIED)

    def apply(self, transition: Transition | None) -> None:
        """Apply a transition that a scene returned, and play its sound.

        A scene whose network cannot be read is not entered: a message says why.
        """
        if transition is not None:
            self._context.sound.play("back" if isinstance(transition, Pop) else "choose")
            self._linger()
        match transition:
            case Push(wanted) | Replace(wanted):
                try:
                    scene = self._made(wanted)
                except ModelFormatError as error:  # a network that comes with the game is damaged
                    self._context.note(str(error))
                    return
                if isinstance(transition, Replace):
                    self._leave(1)
                elif self.stack:
                    self.top.exit()
                self.stack.append(scene)
            case Pop(levels):
                self._pop(levels)
            case Quit():
                self.running = False

    def reset(self, route: Route) -> None:
        """Replace the whole stack without calling `exit` of its scenes, whose state may be broken."""
        self._linger()
        left, self.stack = self.stack, [self._made(route)]
        _close(left)

    def _made(self, scene: Scene | Route) -> Scene:
        return self._scene_of(scene, self._context) if isinstance(scene, Route) else scene

    def close(self) -> None:
        """Leave and close every scene."""
        if self.stack:
            self._leave(len(self.stack))

    def _linger(self) -> None:
        """Keep the present picture, to fade it over the next scene."""
        if self._seen and not self._context.settings.reduced_motion:
            picture, self._fade = self._picture(), _FADE_STEPS
            self._lingering = pygame.Surface(picture.get_size(), pygame.SRCALPHA)
            self._lingering.blit(picture, (0, 0))
            _dim(self._lingering, (self._fade / (_FADE_STEPS + 1)) ** 2)

    def _pop(self, levels: int) -> None:
        if levels >= len(self.stack):
            self.running = False  # `close` calls the top scene's `exit`
            return
        self._leave(levels)
        self.top.enter()

    def _leave(self, levels: int) -> None:
        """Remove the top scenes for good, and free their memory.

        A scene and its widgets are reference cycles with many pictures. Collected only now and then, they took 250 MB
        in an hour; a collection here, between two frames, takes a few milliseconds.
        """
        left = self.stack[-levels:]
        try:
            self.top.exit()
        finally:
            del self.stack[-levels:]
            _close(left)
        del left
        gc.collect()


def _dim(picture: pygame.Surface, share: float) -> None:
    """Leave a share of a picture, 0 to 1: of its colours and of its alpha, as premultiplied blending expects.

    To dim it once and blend it so takes half the time of blending it with an alpha that is set.
    """
    picture.fill([round(255 * share)] * 4, special_flags=pygame.BLEND_RGBA_MULT)


def _close(scenes: list[Scene]) -> None:
    """Close scenes. One that fails does not affect the others."""
    for scene in reversed(scenes):
        try:
            scene.close()
        except Exception:
            _log.exception("closing %s", type(scene).__name__)
