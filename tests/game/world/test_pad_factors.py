"""Score factors stand above their pads, readable, and brighter as one is understood to be meant."""

from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.lander.descent import LegStart
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import TEXT_SIZES
from game.flight.flight import Flight
from game.world.callouts import PadFactors
from game.world.camera import Camera, View

Drawn = dict[str, tuple[pygame.FRect, float]]


@pytest.fixture
def look(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Drawn]:
    canvas, drawn, write = Canvas(pygame.Surface((1280, 720))), {}, Canvas.text

    def noted(self: Canvas, string: str, *args: object, **more: object) -> pygame.FRect:
        box = write(self, string, *args, **more)
        drawn[string] = box, more["alpha"]
        return box

    monkeypatch.setattr(Canvas, "text", noted)

    def seen(flight: Flight, factors: PadFactors, covered: pygame.Rect | None = None) -> Drawn:
        drawn.clear()
        if covered:
            canvas.cover(covered)
        canvas.turn_page()
        factors.draw(canvas, view_of(), flight.env.position[0])
        return dict(drawn)

    return seen


def view_of() -> View:
    return Camera().view(1.0)


def test_each_of_several_pads_has_its_factor_above_it_at_every_size_of_text(look):
    flight = Flight(3, pads=3)
    for growth in TEXT_SIZES.values():
        typeface.grow(growth)
        seen = look(flight, PadFactors(flight))
        assert set(seen) == {"×1", "×3", "×5"}
        for pad in flight.env.ground.pads:
            box, _ = seen[f"×{pad.factor}"]
            x, deck = view_of().points((pad.x, pad.top)).tolist()
            assert box.centerx == pytest.approx(x, abs=1)
            assert deck - 60 < box.bottom < deck
            assert box.height >= 15


def test_a_single_pad_has_none(look):
    flight = Flight(3)
    assert not look(flight, PadFactors(flight))


def test_the_only_goal_of_a_descent_has_none_and_a_flat_spot_brings_both(look):
    for number in range(1, 9):
        flight = Flight(3, leg=LegStart(number))
        factors = {f"×{pad.factor}" for pad in flight.env.ground.pads if pad.factor}
        assert set(look(flight, PadFactors(flight))) == (factors if len(factors) > 1 else set())


def test_the_pad_that_is_aimed_at_is_brightest_and_becomes_so_gently(look):
    flight = Flight(3, pads=3)
    factors = PadFactors(flight)
    for number, pad in enumerate(flight.env.ground.pads):
        flight.env.target[:] = number
        before = factors.meant[number]
        factors.follow(calm=False)
        assert before <= factors.meant[number] <= before + 0.1
        factors.follow(calm=True)
        alphas = {word: alpha for word, (_, alpha) in look(flight, factors).items()}
        assert max(alphas, key=alphas.__getitem__) == f"×{pad.factor}"
        assert min(alphas.values()) > 0.4  # the others can be read as well


def test_the_co_pilots_reading_of_the_pilot_decides_where_there_is_one(look, monkeypatch):
    flight = Flight(3, pads=3)

    class Decision:
        likely = np.array([[0.1, 0.2, 0.7]])

    monkeypatch.setattr(Flight, "shared", True)
    flight.decision = Decision()  # type: ignore[assignment]
    factors = PadFactors(flight)
    assert factors.meant == pytest.approx([0.1, 0.2, 0.7])
    seen = look(flight, factors)
    first, second, third = (seen[f"×{pad.factor}"][1] for pad in flight.env.ground.pads)
    assert first < second < third


def test_a_factor_gives_way_to_a_craft_that_comes_near(look):
    flight = Flight(3, pads=3)
    pad = flight.env.ground.pads[1]
    word, factors, alphas = f"×{pad.factor}", PadFactors(flight), []
    for height in (8.0, 4.5, 3.5):
        flight.env.place(np.ones(1, bool), np.array([[pad.x, pad.top + height, 0, 0, 0, 0]]))
        alphas.append(look(flight, factors).get(word, (None, 0.0))[1])
    assert alphas[0] > alphas[1] > alphas[2]
    flight.env.place(np.ones(1, bool), np.array([[pad.x, pad.top + 1.5, 0, 0, 0, 0]]))
    seen = look(flight, factors)
    assert word not in seen
    assert len(seen) == 2


def test_a_factor_goes_below_its_deck_where_a_panel_stands_above_it(look):
    flight = Flight(3, pads=3)
    pad = flight.env.ground.pads[1]
    factors, word = PadFactors(flight), f"×{pad.factor}"
    box, _ = look(flight, factors)[word]
    panel = pygame.Rect(box).inflate(40, 4)
    lower, _ = look(flight, factors, panel)[word]
    assert lower.top > view_of().points((pad.x, pad.top))[1]
    assert not lower.colliderect(panel)
    again, _ = look(flight, factors, panel)[word]
    assert again.topleft == lower.topleft  # it does not flicker
