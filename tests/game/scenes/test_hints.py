"""Hints and actions: what they name, do and sound like; `tests/game/tour` asks each whether all ways run the same."""

import pygame

from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, VIEW_SIZE
from game.input import signs
from game.input.bindings import KEYBOARD, Bindings, Command
from game.ui.context import Context
from game.ui.form import Form
from game.ui.hints import Hint, HintRow
from tests.support.screens import SCREENS


def test_sentences_name_the_players_own_keys_too(open_game, context: Context):
    bindings = Bindings(KEYBOARD)
    for meaning, code in {Command.FULLSCREEN: pygame.K_F9, Command.FASTER: pygame.K_x}.items():
        bindings.bind(meaning, code)
    context.settings.keys = bindings.to_dict()
    context.settings_file.save(context.settings)
    settings = open_game(SCREENS["SettingsScene"]).top
    assert settings.form.widgets[1]._aside.startswith("F9 ")


def test_what_changes_the_group_of_settings_is_named_as_it_is(open_game):
    driver = open_game(SCREENS["SettingsScene"])
    driver.frames(2)
    named = {hint.meaning: hint.key for hint in driver.top.hints}
    assert named[texts.HINT_CHOOSE] == driver.app.context.controls.arrows_aside
    driver.key(pygame.K_DOWN)
    assert {hint.meaning: hint.key for hint in driver.top.hints}[texts.HINT_CHANGE] == "Enter"


def test_full_screen_is_switched_by_its_key_and_by_a_click(open_game, context: Context):
    driver = open_game(SCREENS["MenuScene"])
    driver.frames(2)
    action = next(entry for entry in driver.top.actions() if getattr(entry, "key", None) is Command.FULLSCREEN)
    for switch in (lambda: driver.key(pygame.K_F11), lambda: driver.click(driver.hints()[action.hint])):
        before = context.settings.full_screen
        switch()
        assert context.settings.full_screen is not before
    assert driver.app.window.full_screen is context.settings.full_screen


def test_a_press_and_a_click_on_its_hint_sound_the_same_and_once(open_game, context: Context, monkeypatch):
    driver = open_game(SCREENS["SettingsScene"])
    driver.frames(2)
    driver.key(pygame.K_DOWN)
    played: list[str] = []
    monkeypatch.setattr(context.sound, "play", played.append)
    driver.key(pygame.K_RETURN)
    by_key, played[:] = list(played), []
    driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(driver.hints()[texts.HINT_CHANGE]), button=1)
    assert len(by_key) == 1
    assert played == by_key


def test_a_hint_is_clicked_where_it_is_written_whether_or_not_it_is_drawn(context: Context):
    canvas, done = Canvas(pygame.Surface(VIEW_SIZE)), []
    hints = [
        Hint("R", "again", lambda: done.append("again")),
        Hint("Space", "stop", lambda: done.append("stop")),
        Hint("wheel", "turn"),
    ]
    row = HintRow(hints, (100, 100))
    again, stop, turn = row.boxes(canvas)
    assert again.right <= stop.left + 12
    form = Form(context)
    form.lay_keys([row], canvas)
    for place in (again.center, stop.center, turn.center, (100, 300)):  # no press does the third
        form.handle_event(pygame.event.Event(pygame.MOUSEBUTTONDOWN, pos=place, button=1))
    assert done == ["again", "stop"]
    before = pygame.surfarray.array3d(canvas.surface)
    row.draw(canvas)
    written = (pygame.surfarray.array3d(canvas.surface) != before).any(axis=(1, 2)).nonzero()[0]
    assert again.left <= written.min()
    assert written.max() <= turn.right


def test_every_sign_is_drawn_and_looks_like_no_other():
    for family in signs.FAMILIES:
        pictures = set()
        for number in signs.SIGNS[family]:
            sign = signs.sign(family, number)
            surface, _ = typeface.render(sign, 20.0, "regular", INK)
            assert surface.get_bounding_rect(1).width > 10
            assert abs(surface.get_width() - typeface.reach(sign, 20.0, "regular")) <= 1
            pictures.add(pygame.image.tobytes(surface, "RGBA"))
        assert len(pictures) == len(signs.SIGNS[family])
