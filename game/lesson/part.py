"""Part of a lesson: a frame, and the walk through the code that belongs to it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from ai.explain.learning_step import Line
from game.lesson.code import CodeWalk
from game.lesson.frame import Frame

# The functions of any network whose lines stand beside its frames, by the ends of their qualified names.
FORWARD: Final = ("NeuralNetwork.forward_propagate", "Layer.forward_propagate", "Normalisation.forward_propagate")
BACKWARD: Final = (".backward_propagate", ".fill_gradients", ".input_error", "Optimizer.step", "._fill_step")


@dataclass(frozen=True)
class Part:
    """One frame of a lesson with its code."""

    frame: Frame
    code: CodeWalk

    @classmethod
    def of(cls, frame: Frame, lines: Iterable[Line], functions: Mapping[str, Callable[..., Any]]) -> Part:
        """Return a frame with those of the lines that ran in its functions.

        Where none ran, the first of these functions that is known is shown as it stands.
        """
        ran = [line for line in lines if frame.functions and line.function.endswith(frame.functions)]
        own = (function for name, function in functions.items() if frame.functions and name.endswith(frame.functions))
        return cls(frame, CodeWalk(ran, functions, next(own, None), frame.begin))
