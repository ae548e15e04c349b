"""All that an object holds, as one can compare it: what drawing must not change."""

from types import FunctionType, MethodType
from typing import Any

import numpy as np
import pygame

from game.audio.mixer import Sound
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.sky import NightSky
from game.ui.context import Context

# Kept so as not to be painted again: of these, drawing may make as it likes.
PICTURES = (Canvas, pygame.Surface, PaintCache, NightSky)
SHARED = (Context, Sound)
COUNTS = {"redraws"}  # of paintings, for tests
PLAIN = (int, float, complex, str, bytes, bool, type(None), type, range)


def is_picture(value: object) -> bool:
    """Whether something is a picture, or a place for some."""
    if isinstance(value, tuple | list):
        return any(map(is_picture, value))
    if isinstance(value, dict):
        return any(map(is_picture, value.values()))
    return isinstance(value, PICTURES)


def state_of(thing: object) -> dict[str, Any]:
    """Return all that a scene holds, by the way there; each object once."""
    found: dict[str, Any] = {}
    ahead, known = [("", thing)], {id(thing)}
    while ahead:
        way, value = ahead.pop()
        inside: list[tuple[str, object]] = []
        if isinstance(value, np.random.Generator):
            found[way] = str(value.bit_generator.state)
        elif isinstance(value, np.ndarray):
            found[way] = (value.shape, value.tobytes())
        elif isinstance(value, PLAIN):
            found[way] = repr(value)
        elif isinstance(value, dict):
            found[way] = repr([key if isinstance(key, PLAIN) else type(key) for key in value])
            inside = [(f"{way}[{number}]", each) for number, each in enumerate(value.values())]
        elif isinstance(value, list | tuple | pygame.Rect | pygame.FRect):
            found[way] = len(value)
            inside = [(f"{way}[{number}]", each) for number, each in enumerate(value)]
        elif isinstance(value, FunctionType | MethodType):
            found[way] = value.__qualname__
        else:
            found[way] = type(value).__name__
            if type(value).__module__.partition(".")[0] in {"game", "ai", "engine"} and not isinstance(value, SHARED):
                inside = [(f"{way}.{name}", each) for name, each in parts(value) if name not in COUNTS]
        for place, each in inside:
            if not is_picture(each) and (isinstance(each, PLAIN) or id(each) not in known):
                known.add(id(each))
                ahead.append((place, each))
    return found


def parts(value: object) -> list[tuple[str, object]]:
    slots = [name for kind in type(value).__mro__ for name in getattr(kind, "__slots__", ())]
    return [*getattr(value, "__dict__", {}).items(), *((name, getattr(value, name, None)) for name in slots)]
