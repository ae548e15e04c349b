"""Part of a lesson: a frame, and the walk through the code that belongs to it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from ai.common.learning_step import Step
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
    def of(
        cls,
        frame: Frame,
        step: Step,
        functions: Mapping[str, Callable[..., Any]],
        fallback: Callable[..., Any] | None = None,
    ) -> Part:
        """Return a frame with the lines of a step that ran in its functions; `fallback` is shown without any."""
        lines = [line for line in step.lines if frame.functions and line.function.endswith(frame.functions)]
        return cls(frame, CodeWalk(lines, functions, fallback))
