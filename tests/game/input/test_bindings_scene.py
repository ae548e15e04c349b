import json

import pygame
import pytest

from game.core import texts
from game.input.bindings import Command, Held
from game.scenes.menus.keys import BindingsScene
from tests.support.driver import Driver

A, B, X, START = (
    pygame.CONTROLLER_BUTTON_A,
    pygame.CONTROLLER_BUTTON_B,
    pygame.CONTROLLER_BUTTON_X,
    pygame.CONTROLLER_BUTTON_START,
)
DOWN, RIGHT = pygame.CONTROLLER_BUTTON_DPAD_DOWN, pygame.CONTROLLER_BUTTON_DPAD_RIGHT


@pytest.fixture
def table(open_game) -> Driver:
    driver = open_game(BindingsScene)
    driver.frames(2)
    return driver


def controls(driver: Driver):
    return driver.app.context.controls


def saved(driver: Driver, name: str) -> dict:
    driver.app.settings_writer.wait()
    return json.loads((driver.app.context.user_dir / "settings.json").read_text())[name]


def begin_with(driver: Driver, name: str) -> None:
    """Show the other half of the table, and go to the key of a command."""
    driver.form.focus(driver.form.widgets[0])
    driver.key(pygame.K_RIGHT)
    driver.form.focus(driver.widget(texts.BINDINGS[name]))


def said(driver: Driver) -> str:
    return driver.top.said


def test_a_key_is_changed_kept_and_named_at_once(table: Driver):
    table.keys(pygame.K_RETURN, pygame.K_f)
    assert saved(table, "keys") == {"main": ["f"]}
    assert controls(table).word(Held.MAIN) == "F"
    assert not controls(table).listening
    assert said(table) == texts.BINDINGS_NOW.format(key="F", gone="↑  ·  Space  ·  W")


def test_a_key_that_is_taken_from_another_is_named_with_it(table: Driver):
    table.keys(pygame.K_RETURN, pygame.K_a)
    now = texts.BINDINGS_NOW.format(key="A", gone="↑  ·  Space  ·  W")
    assert said(table) == f"{now} {texts.BINDINGS_TAKEN.format(key='A', other=texts.BINDINGS['LEFT'])}"
    assert saved(table, "keys") == {"main": ["a"], "left": ["left"]}
    table.keys(pygame.K_RETURN, pygame.K_a)
    assert said(table) == "", "it had that already"


def test_what_menus_need_cannot_be_taken(table: Driver):
    begin_with(table, "RETRY")
    table.key(pygame.K_RETURN)
    for key in (pygame.K_RETURN, pygame.K_UP, pygame.K_BACKSPACE, pygame.K_5):
        table.key(key)
        assert said(table)
        assert controls(table).listening  # for another
    table.key(pygame.K_ESCAPE)
    assert not controls(table).listening
    assert table.top_name == "BindingsScene"
    assert saved(table, "keys") == {}


def test_full_screen_and_pictures_do_not_happen_while_a_key_is_waited_for(table: Driver):
    table.keys(pygame.K_RETURN, pygame.K_F12)
    assert said(table), "it is all that pictures have"
    assert not (table.app.context.user_dir / "screenshots").exists()


def test_the_only_key_of_another_is_refused_by_name_and_another_is_waited_for(table: Driver):
    table.keys(pygame.K_RETURN, pygame.K_f)
    table.keys(*[pygame.K_DOWN] * 4, pygame.K_RETURN, pygame.K_f)
    assert said(table) == texts.BINDINGS_ONLY.format(key="F", other=texts.BINDINGS["MAIN"])
    assert controls(table).listening
    assert saved(table, "keys") == {"main": ["f"]}
    table.key(pygame.K_h)
    assert saved(table, "keys") == {"main": ["f"], "handover": ["h"]}


def test_all_rows_go_back(table: Driver):
    table.keys(pygame.K_RETURN, pygame.K_f, pygame.K_DOWN, pygame.K_RETURN, pygame.K_n)
    assert saved(table, "keys") == {"main": ["f"], "left": ["n"], "next": ["pagedown"]}
    table.press_on(texts.BINDINGS_ALL)
    assert saved(table, "keys") == {}


def test_a_pad_changes_its_own_buttons_and_start_leaves_them(table: Driver):
    table.button(RIGHT)
    table.button(A)
    table.button(START)
    assert not controls(table).listening
    table.button(A)
    table.button(X)
    assert said(table), "it is all that Retry has"
    table.button(pygame.CONTROLLER_BUTTON_GUIDE)
    assert saved(table, "buttons")["main"] == ["guide"]
    assert A not in controls(table).buttons.codes(Command.RETRY)  # it confirms
    table.button(B)
    assert not table.app.scenes.running or table.top_name != "BindingsScene"


def test_a_trigger_can_be_bound(table: Driver):
    table.button(DOWN)
    table.button(RIGHT)
    table.button(A)
    table.axis(pygame.CONTROLLER_AXIS_TRIGGERRIGHT, 30000)
    table.axis(pygame.CONTROLLER_AXIS_TRIGGERRIGHT, 0)
    assert saved(table, "buttons") == {"left": ["triggerright"], "main": ["a", "dpad_up"]}


def test_a_pad_pulled_out_a_click_elsewhere_or_a_leave_ends_the_waiting(table: Driver):
    table.button(RIGHT)
    table.button(A)
    assert controls(table).listening
    table.post(pygame.CONTROLLERDEVICEREMOVED, instance_id=0)
    assert not controls(table).listening
    table.click(table.form.widgets[1].box.center)
    assert controls(table).listening
    table.click(table.widget(texts.BINDINGS_ALL).box.midleft)
    assert not controls(table).listening
