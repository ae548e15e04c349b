"""Every screen can be walked, seen and left by a gamepad alone and by the keyboard alone: real events, no window."""

import time
from collections.abc import Callable, Iterator

import numpy as np
import pygame
import pytest

from ai.digits import DigitClassifier
from ai.pilots import ScriptedPilot
from benchmarks.tour import scene_types
from game import texts
from game.assets import MODELS_DIR
from game.cockpit.skill import Skill
from game.context import Context
from game.flight import Flight
from game.flight_file import Record
from game.records import Records
from game.scene import Push, Scene
from game.scenes.bindings import BindingsScene
from game.scenes.choices import ChoicesScene
from game.scenes.dialog import Asking, Naming, Picking
from game.scenes.digit_training import DigitTrainingScene
from game.scenes.digits import Digits
from game.scenes.dream import Dream
from game.scenes.logbook import Logbook
from game.scenes.menu import Menu
from game.scenes.missions import Missions
from game.scenes.pause import Pause
from game.scenes.physics import Physics
from game.scenes.quiz import Quiz
from game.scenes.replay import Replay
from game.scenes.runs import Runs
from game.scenes.settings import SettingsScene
from game.scenes.train import Train
from game.scenes.watch import Watch
from game.ui.form import Form
from game.ui.listing import Listing
from game.ui.widgets import Widget
from tests.game.driver import Driver

KEYS = {"up": pygame.K_UP, "down": pygame.K_DOWN, "left": pygame.K_LEFT, "right": pygame.K_RIGHT,
        "confirm": pygame.K_RETURN, "back": pygame.K_ESCAPE, "pause": pygame.K_ESCAPE, "stop": pygame.K_SPACE,
        "take over": pygame.K_TAB}  # fmt: skip
BUTTONS = {"up": pygame.CONTROLLER_BUTTON_DPAD_UP, "down": pygame.CONTROLLER_BUTTON_DPAD_DOWN,
           "left": pygame.CONTROLLER_BUTTON_DPAD_LEFT, "right": pygame.CONTROLLER_BUTTON_DPAD_RIGHT,
           "confirm": pygame.CONTROLLER_BUTTON_A, "back": pygame.CONTROLLER_BUTTON_B,
           "pause": pygame.CONTROLLER_BUTTON_START, "stop": pygame.CONTROLLER_BUTTON_RIGHTSTICK,
           "take over": pygame.CONTROLLER_BUTTON_Y}  # fmt: skip
SCREENS: dict[str, Callable[[Context], Scene]] = {
    "Menu": lambda _: Menu(),
    "Missions": lambda _: Missions(),
    "Watch": lambda _: Watch(seed=1),
    "Train": lambda _: Train(),
    "Digits": lambda _: Digits(),
    "DigitTrainingScene": lambda _: DigitTrainingScene(),
    "Dream": lambda _: Dream(reader()),
    "Quiz": lambda _: Quiz(reader()),
    "Physics": lambda _: Physics(),
    "Logbook": lambda _: Logbook(),
    "SettingsScene": lambda _: SettingsScene(),
    "BindingsScene": lambda _: BindingsScene(),
    "Runs": lambda _: Runs(),
    "Replay": lambda context: Replay(flown(context)),
}
OVER_OTHERS: dict[str, Callable[[Scene], Scene]] = {
    "Pause": lambda below: Pause(below, retry=lambda: None),
    "ChoicesScene": lambda below: ChoicesScene(below, Skill([]), begun=False),
    "Asking": lambda below: Asking(below, "?", "", [("yes", lambda: None), ("no", lambda: None)]),
    "Naming": lambda below: Naming(below, "?", "name", lambda _: ""),
    "Picking": lambda below: Picking(below, "?", [("a",), ("b",)], lambda _: None),
}
# Flown rather than walked, shown once something has failed, or a part of others.
NO_SCREENS = {"Play", "Fault", "Dialog", "Vista"}


def reader() -> DigitClassifier:
    return DigitClassifier.load(MODELS_DIR / "digits" / "classic")


def flown(context: Context) -> Record:
    flight = Flight(3, ScriptedPilot())
    flight.hand_over()
    while not flight.over:
        flight.step(0)
    records = Records(context.user_dir)
    return records.read(records.keep(flight, time.time(), alone=True).file)


class Player(Driver):
    """Plays with one device alone."""

    def __init__(self, driver: Driver, device: str) -> None:
        super().__init__(driver.app)
        self.device = device

    def press(self, *names: str) -> None:
        for name in names:
            if self.device == "keys":
                self.key(KEYS[name])
            else:
                self.button(BUTTONS[name])

    def hold(self, frames: int, *names: str) -> None:
        """Hold some down for so many frames."""
        down, up = ((pygame.KEYDOWN, pygame.KEYUP) if self.device == "keys"
                    else (pygame.CONTROLLERBUTTONDOWN, pygame.CONTROLLERBUTTONUP))  # fmt: skip
        for event in (down, up):
            for name in names:
                code = (
                    {"key": KEYS[name], "mod": 0}
                    if self.device == "keys"
                    else {"button": BUTTONS[name], "instance_id": 0}
                )
                self.post(event, **code)
            if event == down:
                self.frames(frames)

    @property
    def form(self) -> Form:
        form = getattr(self.top, "_form", None)
        assert isinstance(form, Form)
        return form

    def go_to(self, wanted: Widget) -> None:
        """Move the focus to a widget by the arrows alone, whichever way leads there."""
        way = ways(self)[self.form.widgets.index(wanted)]
        for step in way:
            lead_on(self, step)
        assert self.form.focused is wanted

    def choose(self, label: str) -> None:
        """Go to the widget of that name, and press it."""
        self.go_to(next(widget for widget in self.form.widgets if widget.label == label))
        self.press("confirm")
        self.frames(2)


def lead_on(player: Player, direction: str) -> None:
    """Press a direction until the focus moves, as often as a list has rows, or a choice options."""
    before = player.form.focused
    steps = len(before.rows) if isinstance(before, Listing) else len(getattr(before, "options", "  "))
    for _ in range(steps + 1):
        player.press(direction)
        if player.form.focused is not before:
            return


def ways(player: Player) -> dict[int, list[str]]:
    """Return how to get to each widget that the arrows lead to, from where the focus is; it stays there."""
    form = player.form
    assert form.focused is not None
    start = form.widgets.index(form.focused)
    found: dict[int, list[str]] = {start: []}
    ahead = [start]
    for index in ahead:
        for direction in ("down", "up", "right", "left"):
            if index >= len(form.widgets):
                break
            form.focus(form.widgets[index])
            lead_on(player, direction)
            form = player.form
            reached = form.widgets.index(form.focused)
            if reached not in found:
                found[reached] = [*found[index], direction]
                ahead.append(reached)
    form.focus(form.widgets[min(start, len(form.widgets) - 1)])
    return found


@pytest.fixture(params=["keys", "pad"])
def open_screen(
    request: pytest.FixtureRequest, open_game: Callable[..., Driver], context: Context
) -> Iterator[Callable[..., Player]]:
    def open_it(make: Callable[[Context], Scene]) -> Player:
        context.settings.reduced_motion = True
        context.settings_file.save(context.settings)
        player = Player(open_game(make(context)), request.param)
        player.frames(3)
        return player

    return open_it


def test_every_screen_there_is_will_be_walked():
    assert {each.__name__ for each in scene_types()} - NO_SCREENS == SCREENS.keys() | OVER_OTHERS.keys()


@pytest.mark.parametrize("name", SCREENS)
def test_every_widget_is_reached_and_seen_and_there_is_a_way_out(open_screen, name: str):
    player = open_screen(SCREENS[name])
    if name in ("Watch", "Physics", "Replay"):
        player.press("stop")
    walk(player)
    for _ in range(3):
        if player.app.scenes.running and player.top_name != "Pause":
            player.press("back")
    if player.top_name == "Pause":
        player.choose(texts.PAUSE_LEAVE)
    assert not player.app.scenes.running  # it was the only scene


@pytest.mark.parametrize("name", OVER_OTHERS)
def test_so_are_those_that_stand_over_another(open_screen, name: str):
    player = open_screen(SCREENS["Menu"])
    menu = player.top
    player.app.scenes.apply(Push(OVER_OTHERS[name](menu)))
    player.frames(3)
    if name == "Naming":
        player.press("down")  # out of the line, with what stands there
    walk(player)
    player.press("back")
    assert player.top is menu


def walk(player: Player) -> None:
    found = ways(player)
    player.app.context.settings.reduced_motion = True
    widgets = list(player.form.widgets)  # what is chosen on the way may have changed them
    assert not [widget.label for index, widget in enumerate(widgets) if index not in found]
    for widget in widgets[:24]:
        if widget in player.form.widgets:
            assert is_seen(player, widget), f"no focus is seen on {widget.label}"


def is_seen(player: Player, widget: Widget) -> bool:
    """Whether the picture around a widget changes when the focus comes to it."""
    form, canvas = player.form, player.app.canvas
    pictures = []
    for focused in (next((each for each in form.widgets if each is not widget), widget), widget):
        form.focus(focused)
        player.frames(2)
        around = canvas.rect(*widget.box.inflate(28, 16)).clip(canvas.surface.get_rect())
        pictures.append(pygame.surfarray.array3d(canvas.surface.subsurface(around)).astype(int))
    return len(form.widgets) == 1 or int((np.abs(pictures[0] - pictures[1]).max(axis=2) > 40).sum()) >= 12
