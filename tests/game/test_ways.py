"""A key takes the way to the thrust that docs/architecture.md describes."""

import re
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import pygame

from game.core.scene import Route
from game.scenes import scene_of
from tests.support.driver import Driver

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
STICK, AIR, GROUND = "game/input/analogue.py", "ai/lander/free_flight.py", "engine/integrate.py"
STEP = "game/flight/flight.py"  # paths and wrecks fly as well, but not by the key
MOST = 12


def test_a_key_passes_the_files_that_the_map_names_and_no_others(open_game: Callable[..., Driver]):
    driver = open_game(lambda context: scene_of(Route("play", options={"seed": 12}), context))
    driver.frames(2)
    driver.unseen = True
    driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0)
    seen = files_passed(lambda: driver.skip(2))
    env = driver.top.flight.env
    env.place(np.ones(1, bool), np.array([[0.0, 3.0, 0.0, -3.0, 0.0, 0.0]]))
    seen |= files_passed(lambda: driver.skip(16))
    assert seen >= {STICK, AIR, GROUND}
    paragraph = next(each for each in PAGE.split("\n\n") if each.startswith("**From a key to the thrust"))
    named = set(re.findall(r"`((?:engine|ai|game)/[\w/]+\.py)`", paragraph))
    assert named == seen
    assert len(named - {AIR}) <= MOST  # near the ground, where the engine moves the craft


def files_passed(play: Callable[[], Any]) -> set[str]:
    """Return the files through which calls go to the stick, and through a flight's step to what moves the craft."""
    passed: set[str] = set()

    def look(frame: FrameType | None, event: str, _: object) -> None:
        assert frame
        if event != "call" or not frame.f_code.co_filename.endswith((STICK, AIR, GROUND, "craft.py")):
            return
        stack = []
        while frame:
            path = Path(frame.f_code.co_filename)
            if path.is_relative_to(ROOT) and path.parts[len(ROOT.parts)] in ("engine", "ai", "game"):
                stack.append(path.relative_to(ROOT).as_posix())
            frame = frame.f_back
        if stack[0] == STICK or STEP in stack:
            passed.update(stack)

    sys.setprofile(look)
    try:
        play()
    finally:
        sys.setprofile(None)
    return passed
