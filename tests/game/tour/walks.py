"""Every screen can be walked, seen and left by the keyboard, a gamepad and the mouse, each of them alone."""

import numpy as np
import pygame

from game.core import texts
from game.ui.widget import Widget
from tests.game.tour.stops import Stop
from tests.support.driver import Driver
from tests.support.player import DEVICES, Player
from tests.support.screens import SCREENS


def devices(stop: Stop) -> tuple[str, ...]:
    """Return what a screen is walked through and left with: those over others by keys and pad alone, flights not."""
    return (*DEVICES, *(["mouse"] if stop.screen in SCREENS else [])) if stop.walked else ()


def walk(driver: Driver, screen: str, device: str) -> None:
    """Reach every widget, and leave."""
    if device == "mouse":
        the_mouse_alone_finds_a_way_out(driver)
        return
    player = Player(driver, device)
    below = player.app.scenes.stack[:-1]
    if screen in ("WatchScene", "PhysicsScene", "ReplayScene"):
        player.press("step")
    if screen == "NameDialog":
        player.press("down")  # out of the line, with what stands there
    every_widget_is_reached(player)
    if below:
        player.press("back")
        assert player.app.scenes.stack == below, "there is no way back"
        return
    if screen == "MenuScene":
        player.press("back")  # to Quit
        player.press("confirm")
    for _ in range(3):
        if player.app.scenes.running and "PauseScene" not in player.top_name:
            player.press("back")
    if "PauseScene" in player.top_name:
        player.choose(texts.PAUSE_LEAVE)
    elif player.app.scenes.running:
        player.press("confirm")  # Quit, to which the title has led
    assert not player.app.scenes.running, "there is no way out"


def every_widget_is_reached(player: Player) -> None:
    player.unseen = True
    found = player.ways()
    player.unseen, player.app.context.settings.reduced_motion = False, True
    widgets = list(player.form.widgets)  # what is chosen on the way may have changed them
    assert not [widget.label for index, widget in enumerate(widgets) if index not in found], "these are not reached"
    kinds = {type(widget): widget for widget in widgets}  # the last of each: all of a kind draw it by the same lines
    for widget in kinds.values() if player.device == "keys" else ():  # and so they do for a gamepad
        if widget in player.form.widgets:
            assert is_seen(player, widget), f"no focus is seen on {widget.label}"


def is_seen(player: Player, widget: Widget) -> bool:
    """Whether the picture around a widget changes when the focus comes to it."""
    form, canvas = player.form, player.app.canvas.reading
    pictures = []
    for focused in (next((each for each in form.widgets if each is not widget), widget), widget):
        form.focus(focused)
        player.unseen = True
        player.frames(1)
        player.unseen = False
        player.frames(1)
        around = canvas.rect(*widget.box.inflate(28, 16)).clip(canvas.surface.get_rect())
        if not around.width or not around.height:
            assert focused is not widget, "it is scrolled away"
            return True  # it comes into view with the focus
        pictures.append(pygame.surfarray.array3d(canvas.surface.subsurface(around)).astype(int))
    height = min(picture.shape[1] for picture in pictures)  # a panel may have scrolled by part of a pixel
    pictures = [picture[:, :height] for picture in pictures]
    return len(form.widgets) == 1 or int((np.abs(pictures[0] - pictures[1]).max(axis=2) > 40).sum()) >= 12


def the_mouse_alone_finds_a_way_out(game: Driver) -> None:
    game.move((640, 700))
    game.frames(3)
    for _ in range(3):
        if not game.app.scenes.running:
            break
        words = {word.label: word for word in game.top.form.widgets}
        exits = [label for label in (texts.BACK, texts.PAUSE_LEAVE, texts.MENU["quit"][0]) if label in words]
        if exits:
            game.click(words[exits[0]].box.center)
        else:
            hints = game.hints()
            game.click(hints.get(texts.HINT_BACK) or hints[texts.HINT_PAUSE])
        game.frames(3)
    assert not game.app.scenes.running, "there is no way out"
