import shutil
from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.digits.preprocessing import preprocess_strokes
from game.core import texts
from game.scenes.digits.reader import Verdict
from game.scenes.digits.scene import DigitsScene
from game.ui.context import Context
from game.ui.virtual_pointer import PictureRow
from tests.support.chores import biased_fix
from tests.support.driver import Driver
from tests.support.pen import draw, guess, strokes
from tests.support.player import DEVICES, Player
from tests.support.screens import save_settings

Open = Callable[..., Driver]


@pytest.fixture
def drawing(open_game: Open) -> Driver:
    return open_game(DigitsScene)


def scene(driver: Driver) -> DigitsScene:
    assert isinstance(driver.top, DigitsScene)
    return driver.top


def test_all_ten_digits_are_read_however_small(drawing: Driver):
    read = {}
    drawing.press_on("More")
    for index, chosen in enumerate(("modern", "classic")):
        drawing.choice("Classic").choose(index)
        read[chosen] = []
        for digit in range(10):
            draw(drawing, strokes(digit, 0, 0.12, (0.05, 0.8)))
            read[chosen].append(guess(drawing) == digit)
            drawing.key(pygame.K_r)
    assert sum(read["modern"]) == 10
    assert sum(read["classic"]) >= 9


def test_the_guess_follows_every_event_without_a_frame_in_between(drawing: Driver):
    digits, (stroke,) = scene(drawing), strokes(0)
    assert digits.probabilities is None
    guesses = []
    for number, point in enumerate(stroke * digits.pad.rect.size + digits.pad.rect.topleft):
        kind = pygame.MOUSEMOTION if number else pygame.MOUSEBUTTONDOWN
        digits.handle_event(pygame.event.Event(kind, pos=tuple(point), button=1))
        guesses.append(digits.probabilities)
    assert len({guess.tobytes() for guess in guesses}) == len(stroke)
    assert guesses[-1].argmax() == 0


def test_the_drawing_area_is_given_in_pixels_of_the_window(drawing: Driver):
    for size, scale in (((1280, 720), 1.0), ((900, 760), 1.0), ((2560, 1440), 2.0)):
        drawing.resize(size)
        left, top, width, height = scene(drawing).canvas_rect
        assert (left, top) == pytest.approx([scale * each for each in scene(drawing).pad.rect.topleft], abs=1)
        assert width == height == pytest.approx(scale * scene(drawing).pad.rect.width, abs=1)
        drawing.post(pygame.MOUSEBUTTONDOWN, pos=(left + 5, top + 5), button=1)
        assert scene(drawing).pad.drawing
        drawing.post(pygame.MOUSEBUTTONUP, pos=(left + 5, top + 5), button=1)


def test_what_is_no_digit_makes_it_unsure(drawing: Driver):
    dot, line, tick = [(0.5, 0.5)], [(0.1, 0.5), (0.9, 0.5)], [(0.5, 0.5), (0.52, 0.51)]
    for drawn in (dot, line, tick, np.random.default_rng(4).random((40, 2))):
        draw(drawing, [np.array(drawn)])
        assert guess(drawing) in range(10)
        assert [scene(drawing).reading.verdict(name) for name in ("modern", "classic")] == [Verdict.UNSURE] * 2, drawn
        drawing.key(pygame.K_r)


def test_undo_and_clear_by_keys_a_word_and_pad(drawing: Driver):
    pad = scene(drawing).pad
    draw(drawing, strokes(4))
    assert len(pad.strokes) == 2
    drawing.keys(pygame.K_z, pygame.K_z)
    assert not pad.strokes
    draw(drawing, strokes(4))
    drawing.press_on("Clear")
    assert scene(drawing).probabilities is None
    draw(drawing, strokes(4))
    drawing.button(pygame.CONTROLLER_BUTTON_Y)
    assert len(pad.strokes) == 1
    drawing.button(pygame.CONTROLLER_BUTTON_X)
    assert not pad.strokes


def test_what_is_put_right_is_what_is_drawn_however_soon_that_is(drawing: Driver, monkeypatch):
    digits, given = scene(drawing), []
    monkeypatch.setattr(digits.fixing, "begin", lambda _, image, digit: given.append((image, digit)))
    draw(drawing, strokes(2))
    drawing.key(pygame.K_7)  # it has not been read yet
    [(image, digit)] = given
    assert digit == 7
    assert np.array_equal(image, preprocess_strokes(digits.pad.strokes))


def test_an_empty_pad_asks_no_why(drawing: Driver, written: list[str]):
    drawing.frames(2)
    assert not [words for words in written if words.startswith("WHY")]
    draw(drawing, strokes(7))
    drawing.frames(10)
    assert [words for words in written if words.startswith("WHY")]


def test_the_answer_stays_on_the_screen_beside_the_pad(open_game: Open, context: Context):
    save_settings(context, text_size="largest")
    driver = open_game(DigitsScene)
    driver.resize((800, 600))
    draw(driver, strokes(7))
    driver.frames(10)
    digits, panel = scene(driver), scene(driver).panel
    answer = panel.rows[0].box.top
    assert panel.scrolled == 0
    assert answer <= digits.pad.rect.top
    assert digits._bars.box.left > digits.pad.rect.right
    assert digits._bars.place(0).bottom < panel.box.bottom


def test_words_lead_further_in_once_there_is_a_drawing_which_is_kept(drawing: Driver):
    digits = scene(drawing)
    drawing.press_on("Look inside")
    assert drawing.top is digits
    drawing.frames(2)
    assert drawing.said == texts.DIGITS_EMPTY
    draw(drawing, strokes(6))
    for word, name in (("Look inside", "DigitInsideScene"), ("Train", "TrainScene")):
        drawing.click(drawing.widget(word).box.center)
        assert drawing.top_name == name
        drawing.key(pygame.K_ESCAPE)
        while drawing.top is not digits and "PauseScene" in drawing.top_name:
            drawing.keys(pygame.K_UP, pygame.K_RETURN)  # Leave
        assert drawing.top is digits
    assert guess(drawing) == 6


def test_damaged_networks_are_named_and_what_is_left_reads(open_game: Open, context: Context, tmp_path):
    shutil.copytree(context.models_dir / "digits", tmp_path / "models" / "digits")
    (tmp_path / "models" / "digits" / "modern" / "config.json").write_text("{", encoding="utf-8")
    context.models_dir = tmp_path / "models"
    driver = open_game(DigitsScene)
    assert scene(driver).chosen == "classic"
    assert "config.json" in scene(driver).live.problems["modern"]
    draw(driver, strokes(3))
    assert guess(driver) == 3
    shutil.rmtree(context.models_dir)
    driver = open_game(DigitsScene)
    draw(driver, strokes(3))
    driver.key(pygame.K_3)
    assert scene(driver).probabilities is None
    assert set(scene(driver).live.problems) == {"modern", "classic"}
    driver.press_on(texts.MORE[False])
    driver.frames(2)
    assert driver.top_name == "DigitsScene"


def test_a_fix_is_learnt_in_the_background_shown_and_undone(drawing: Driver, context: Context, monkeypatch):
    monkeypatch.setattr("game.scenes.digits.fixing.fix", biased_fix)
    digits = scene(drawing)
    draw(drawing, strokes(1, 1))
    assert guess(drawing) == 1
    drawing.key(pygame.K_7)
    assert digits.fixing.busy
    drawing.wait(lambda: not digits.fixing.busy)
    assert guess(drawing) == 7
    assert digits.fixing.fixed.digit == 7
    drawing.frames(2)
    assert (context.user_dir / "digits" / "modern").is_dir()
    drawing.press_on("Undo the fix")
    assert guess(drawing) == 1


# A digit is drawn, and read, by the keyboard alone and by a gamepad alone.


def take_the_pen(player: Player) -> None:
    for direction in ["left"] * 2 + ["down"] * 14 + ["left"] * 2:
        if isinstance(player.form.focused, PictureRow):
            break
        player.press(direction)
    player.press("confirm")
    assert player.form.typing


def go(player: Player, direction: str, frames: int) -> None:
    player.hold(direction, down=True)
    player.frames(frames)
    player.hold(direction, down=False)


@pytest.mark.parametrize("device", DEVICES)
def test_a_one_is_drawn_and_read_without_a_mouse(drawing: Driver, device: str):
    player = Player(drawing, device)
    player.frames(3)
    take_the_pen(player)
    go(player, "up", 32)
    assert not player.top.pad.strokes
    player.hold("confirm", down=True)
    go(player, "down", 64)
    player.hold("confirm", down=False)
    go(player, "right", 20)
    [stroke] = player.top.pad.strokes
    assert stroke[-1][1] - stroke[0][1] > 250
    assert abs(stroke[-1][0] - stroke[0][0]) < 2
    assert player.top.probabilities.argmax() == 1
    player.press("back")
    assert not player.form.typing
    assert player.top_name == "DigitsScene"
    player.press("back")
    assert not player.app.scenes.running
