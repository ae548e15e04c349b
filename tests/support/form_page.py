"""A scene of nothing but a form, for tests of widgets."""

import pygame

from game.core.scene import Pop, Scene, Transition
from game.drawing.canvas import Canvas
from game.ui.context import Context
from game.ui.form import Form


class FormPage(Scene):
    """Black page with the widgets that a test adds to `form`; `log` is for what they say."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.log: list[object] = []
        self.form = Form(context, on_back=Pop)

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        return self.form.handle_event(event)

    def update(self) -> Transition | None:
        return self.form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        canvas.surface.fill((0, 0, 0))
        self.form.draw(canvas)
