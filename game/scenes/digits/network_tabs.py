"""Row of the networks that read digits, and what is wrong with those that can't be loaded."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

from game.core import texts
from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import TEXT
from game.scenes.digits.answer import LEFT
from game.training.digit_models import NAMES, called
from game.ui.pick import ChoiceOrList
from game.ui.widget import PointsManager
from game.ui.widgets import Choice

_BOX: Final = (LEFT, 26, 252, 24)  # above the chosen one's answer
_LONGEST: Final = 16  # letters
_PROBLEMS: Final = 650.0  # baseline of the problems, bottom line first
_PROBLEM_LINES: Final = 4


def network_tabs(
    manager: PointsManager,
    names: Sequence[str],
    chosen: str,
    on_choose: Callable[[int], None],
    on_open: Callable[[], Transition],
) -> Choice:
    """Return the row of networks; with networks of the player's own, it also leads to a list of all."""
    words = [word if len(word) <= _LONGEST else word[:_LONGEST] + "…" for word in map(called, names)]
    index = names.index(chosen) if chosen in names else 0
    if len(names) == len(NAMES):
        return Choice(manager, _BOX, "", words, index, on_choose)
    everything = texts.DIGITS_ALL.format(count=len(names))
    return ChoiceOrList(manager, _BOX, "", words, index, on_choose, on_open, everything, size=TEXT)


def draw_problems(canvas: Canvas, problems: Mapping[str, str]) -> None:
    """Write why networks can't be loaded, by their names, as far as there is room."""
    y: float = _PROBLEMS
    for name, problem in reversed(list(problems.items())):
        most = _PROBLEM_LINES - round((y - _PROBLEMS) / 17)
        words = texts.DIGITS_PROBLEM.format(name=called(name), problem=problem)
        y = draw_wrapped(canvas, words, (LEFT, y), _BOX[2], colour=canvas.palette.warn, leading=17, most=most)
