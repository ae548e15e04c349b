"""The way of a key press to its thrust, traced in a flight, is as short as docs/architecture.md says."""

import re
import sys
from pathlib import Path
from types import FrameType

import pygame

from ai.lander.environment import LanderEnv
from game.flight.choosers import Crew
from game.input import analogue
from game.input.controls import Controls
from game.scenes.play.scene import PlayScene

ROOT = Path(__file__).parents[3]
MARKS = (Controls.process.__code__, analogue.pushed.__code__, LanderEnv.fly.__code__, Crew.choose.__code__)
MOST = 12


def test_a_press_reaches_the_thrust_through_twelve_files_at_most_and_the_document_names_them(open_game):
    driver = open_game(PlayScene, 3)
    driver.frames(2)
    play = driver.top
    passed: set[str] = set()

    def trace(frame: FrameType, event: str, _: object) -> None:
        if event != "call" or frame.f_code not in MARKS:
            return
        if frame.f_code is MARKS[2] and frame.f_locals["self"] is not play.flight.env:
            return  # of a flight that is flown ahead
        way: FrameType | None = frame
        while way:
            file = Path(way.f_code.co_filename)
            if file.is_relative_to(ROOT / "game"):
                passed.add(file.relative_to(ROOT).as_posix())
            way = way.f_back

    sys.setprofile(trace)
    driver.key(pygame.K_UP)
    driver.frames(2)
    sys.setprofile(None)
    assert play.flight.env.fuel[0] > 0
    [told] = re.findall(r"\*\*From a key to the thrust.*", (ROOT / "docs" / "architecture.md").read_text())
    named = set(re.findall(r"`(game/[\w/]+\.py)`", told))
    assert passed <= named  # and what is asked on the way: what a key means, and a guard
    assert len(named) <= MOST, sorted(named)
