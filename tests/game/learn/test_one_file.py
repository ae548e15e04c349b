"""The whole thing in one file: every line of it is shown, and each part's door leads to what it grew up to be."""

from collections.abc import Callable

import pygame
import pytest

from game.core import texts
from game.core.assets import MICROLANDER
from game.scenes import ROUTES
from game.scenes.learn.list import LearnScene
from game.scenes.learn.one_file import DOORS, OneFileScene, parts
from game.scenes.learn.scene import ChapterScene
from tests.support.driver import Driver

Open = Callable[..., Driver]


def test_the_parts_are_the_file_from_its_first_part_on():
    lines = MICROLANDER.read_text().splitlines()
    shown = dict(line for part in parts() for line in part.source.lines)
    first = min(shown)
    assert not [line for line in lines[: first - 1] if line.startswith(("def ", "class "))]
    left_out = [line for number, line in enumerate(lines[first - 1 :], first) if shown.get(number) != line]
    assert not [line for line in left_out if line]
    assert len(parts()) == len(DOORS) == len(texts.ONE_FILE_PARTS)


def test_learn_begins_with_it(open_game: Open):
    driver = open_game(LearnScene)
    assert driver.top.form.widgets[0].label == texts.ONE_FILE
    driver.keys(pygame.K_UP, pygame.K_RETURN)
    driver.frames(20)
    assert isinstance(driver.top, OneFileScene)


@pytest.mark.parametrize("number", range(len(DOORS)))
def test_each_part_has_its_lines_and_a_door(open_game: Open, number: int, written: list[str]):
    driver = open_game(OneFileScene)
    scene = driver.top
    driver.keys(*[pygame.K_DOWN] * number)
    driver.frames(3)
    assert scene.chosen == number
    text = "".join("".join(written).split())
    source = parts()[number].source
    for _, line in source.lines[:6]:
        assert "".join(line.split()) in text
    assert parts()[number].grown_up in " ".join(written)
    driver.key(pygame.K_RETURN)
    driver.frames(20)
    door = DOORS[number]
    if isinstance(driver.top, ChapterScene):
        assert driver.top.key == door
    else:
        assert type(driver.top).__name__ == ROUTES[door].rpartition(".")[2]
