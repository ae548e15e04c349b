"""Plays the game in a test by the keyboard alone, or by a gamepad alone."""

import pygame

from ai.lander.pilots import Pilot, ScriptedPilot
from game.scenes.play.scene import PlayScene
from game.ui.listing import ListRow
from game.ui.widget import Widget
from tests.support.driver import Driver

KEYS = {"up": pygame.K_UP, "down": pygame.K_DOWN, "left": pygame.K_LEFT, "right": pygame.K_RIGHT,
        "confirm": pygame.K_RETURN, "back": pygame.K_ESCAPE, "pause": pygame.K_ESCAPE, "step": pygame.K_PERIOD,
        "main": pygame.K_SPACE, "hand over": pygame.K_TAB, "another": pygame.K_f, "reset": pygame.K_r}  # fmt: skip
BUTTONS = {"up": pygame.CONTROLLER_BUTTON_DPAD_UP, "down": pygame.CONTROLLER_BUTTON_DPAD_DOWN,
           "left": pygame.CONTROLLER_BUTTON_DPAD_LEFT, "right": pygame.CONTROLLER_BUTTON_DPAD_RIGHT,
           "confirm": pygame.CONTROLLER_BUTTON_A, "back": pygame.CONTROLLER_BUTTON_B,
           "pause": pygame.CONTROLLER_BUTTON_START, "step": pygame.CONTROLLER_BUTTON_RIGHTSTICK,
           "main": pygame.CONTROLLER_BUTTON_A, "hand over": pygame.CONTROLLER_BUTTON_Y,
           "another": pygame.CONTROLLER_BUTTON_GUIDE, "reset": pygame.CONTROLLER_BUTTON_X}  # fmt: skip
DEVICES = ("keys", "pad")


class Player(Driver):
    """Plays with one device alone."""

    def __init__(self, driver: Driver, device: str) -> None:
        super().__init__(driver.app)
        self.device = device

    def press(self, *names: str) -> None:
        for name in names:
            self.hold(name, down=True, drawn=False)
            self.hold(name, down=False)

    def hold(self, name: str, *, down: bool, drawn: bool = True) -> None:
        """Press something, or let go of it."""
        self._tell(name, down=down)
        self._play(drawn=drawn)

    def _tell(self, name: str, *, down: bool) -> None:
        if self.device == "keys":
            event = pygame.Event(pygame.KEYDOWN if down else pygame.KEYUP, key=KEYS[name], mod=0)
        else:
            kind = pygame.CONTROLLERBUTTONDOWN if down else pygame.CONTROLLERBUTTONUP
            event = pygame.Event(kind, button=BUTTONS[name], instance_id=0)
        pygame.event.post(event)

    def choose(self, label: str) -> None:
        """Go to the widget of that name, down and up each column, and press it."""
        for direction in ("down", "up", "right", "down", "left", "up"):
            for _ in self.form.widgets:
                if self.form.focused is not None and self.form.focused.label == label:
                    self.press("confirm")
                    self.frames(2)
                    return
                self.lead_on(direction)
        raise AssertionError(f"there is no way to {label}")

    def lead_on(self, direction: str) -> None:
        """Press a direction until the focus moves, as often as a list has rows, or a choice options."""
        before, place = self.form.focused, self._index
        steps = len(before.rows) if isinstance(before, ListRow) else len(getattr(before, "options", "  "))
        for _ in range(steps + 1):
            self.press(direction)
            if self._index != place:  # what is chosen in a list describes its screen anew
                return

    def ways(self) -> dict[int, list[str]]:
        """Return how to get to each widget that the arrows lead to, from where the focus is."""
        start = self._index
        found: dict[int, list[str]] = {start: []}
        ahead = [start]
        for index in ahead:
            for direction in ("down", "up", "right", "left"):
                if index < len(self.form.widgets):
                    self.form.focus(self.form.widgets[index])
                    self.lead_on(direction)
                    if self._index not in found:
                        found[self._index] = [*found[index], direction]
                        ahead.append(self._index)
        return found

    @property
    def _index(self) -> int:
        focused: Widget | None = self.form.focused
        assert focused is not None
        return self.form.widgets.index(focused)

    def fly(self, pilot: Pilot | None = None, most: int = 3600) -> None:
        """Fly as a pilot would, until the flight is over."""
        pilot, held = pilot or ScriptedPilot(), set[str]()
        self.press("main")  # it waits for the first touch
        for _ in range(most):
            assert isinstance(self.top, PlayScene)
            flight = self.top.flight
            if flight.over:
                break
            action = int(pilot.act(flight.env.observe())[0])
            wanted = {"main"} if action >= 3 else set[str]()
            wanted |= {("", "left", "right")[action % 3]} - {""}
            for name in held ^ wanted:
                self._tell(name, down=name in wanted)
            held = wanted
            self.skip(1)
        for name in held:
            self.hold(name, down=False)
