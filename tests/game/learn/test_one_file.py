"""The whole thing in one file: every line of it is shown, part by part."""

from collections.abc import Callable

import pygame

from game.core import texts
from game.core.assets import MICROLANDER
from game.scenes.learn.list import LearnScene
from game.scenes.learn.one_file import OneFileScene, parts
from tests.support.driver import Driver

Open = Callable[..., Driver]


def test_the_parts_are_the_file_from_its_first_part_on():
    lines = MICROLANDER.read_text().splitlines()
    shown = dict(line for part in parts() for line in part.lines)
    first = min(shown)
    assert not [line for line in lines[: first - 1] if line.startswith(("def ", "class "))]
    assert [shown[number] for number in range(first, len(lines) + 1)] == lines[first - 1 :]
    assert len(parts()) == len(texts.ONE_FILE_PARTS)


def test_learn_begins_with_it_and_each_part_has_its_lines(open_game: Open, written: list[str]):
    driver = open_game(LearnScene)
    assert driver.top.form.widgets[0].label == texts.ONE_FILE
    driver.keys(pygame.K_UP, pygame.K_RETURN)
    driver.frames(20)
    assert isinstance(driver.top, OneFileScene)
    for number, part in enumerate(parts()):
        assert driver.top.chosen == number
        driver.frames(3)
        text = "".join("".join(written).split())
        assert all("".join(line.split()) in text for _, line in part.lines[:6])
        assert part.name in " ".join(written)
        driver.key(pygame.K_DOWN)
