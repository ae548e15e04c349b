"""Listing of code: it shows the lines of the function that runs, and keeps the current one in sight."""

import inspect
from typing import Any

import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.nn.layer import Layer
from ai.training.loop import Training
from game.core.source import source_of
from game.drawing.canvas import Canvas
from game.explain.code_listing import draw_listing


def test_the_source_has_the_lines_of_the_file_but_not_the_docstring():
    source = source_of(DeepQAgent.gradient_step)
    lines, first = inspect.getsourcelines(DeepQAgent.gradient_step)
    assert source.path == "ai/agent/agent.py"
    assert source.name == "DeepQAgent.gradient_step"
    assert source.lines[0][0] == first
    for number, text in source.lines:
        assert lines[number - first].strip() == text.strip()
    assert not any('"""' in text for _, text in source.lines)


@pytest.mark.parametrize("function", [Layer.single_step, Training.advance])
def test_remarks_for_tools_are_not_shown(function):
    raw = inspect.getsource(function)
    assert "# noqa" in raw or "# fmt" in raw
    shown = "\n".join(line for _, line in source_of(function).lines)
    assert "# noqa" not in shown
    assert "# fmt" not in shown


def test_a_function_without_a_source_has_none():
    assert source_of(len) is None


@pytest.mark.parametrize("room", [60, 120, 400])
def test_the_current_line_is_in_sight_however_little_room_there_is(room):
    source = source_of(DeepQAgent.train_step)
    for number, _ in source.lines:
        canvas: Any = Canvas(pygame.Surface((1280, 720)))
        written = []
        canvas.text = lambda string, *_, **__: written.append(string)  # noqa: B023
        draw_listing(canvas, (40, 40, 500, room), source, number)
        assert str(number) in written
