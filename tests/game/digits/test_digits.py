import shutil
import time
from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.digits.preprocessing import preprocess_strokes
from game.core import texts
from game.drawing.tokens import INK
from game.scenes.digits.reader import Verdict
from game.scenes.digits.scene import DigitsScene
from game.ui.context import Context
from tests.support.chores import biased_fix
from tests.support.driver import Driver
from tests.support.pen import draw, guess, pad_of, strokes

Open = Callable[..., Driver]


@pytest.fixture
def drawing(open_game: Open) -> Driver:
    return open_game(DigitsScene)


def scene(driver: Driver) -> DigitsScene:
    assert isinstance(driver.top, DigitsScene)
    return driver.top


def wait_for(driver: Driver, done: Callable[[], object]) -> None:
    started = time.monotonic()
    while not done() and time.monotonic() - started < 120:
        driver.frames(1)
        time.sleep(0.005)
    assert done()


@pytest.mark.parametrize(
    ("height", "at", "size"),
    [(0.6, (0.3, 0.2), (1280, 720)), (0.12, (0.05, 0.8), (1280, 720)), (0.9, (0.1, 0.05), (900, 760))],
)
def test_all_ten_digits_are_read_at_any_size_and_place(drawing: Driver, height, at, size):
    drawing.resize(size)
    read = {}
    for chosen in ("modern", "classic"):
        read[chosen] = []
        for digit in range(10):
            draw(drawing, strokes(digit, 0, height, at))
            read[chosen].append(guess(drawing) == digit)
            drawing.key(pygame.K_c)
        drawing.key(pygame.K_n)
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
        left, top, width, height = pad_of(drawing)
        assert (left, top) == pytest.approx([scale * each for each in scene(drawing).pad.rect.topleft], abs=1)
        assert width == height == pytest.approx(scale * scene(drawing).pad.rect.width, abs=1)
        drawing.post(pygame.MOUSEBUTTONDOWN, pos=(left + 5, top + 5), button=1)
        assert scene(drawing).pad.drawing
        drawing.post(pygame.MOUSEBUTTONUP, pos=(left + 5, top + 5), button=1)


def test_a_resized_window_keeps_the_drawing(drawing: Driver):
    draw(drawing, strokes(3))
    before = scene(drawing).probabilities
    drawing.resize((1600, 900))
    assert np.array_equal(scene(drawing).probabilities, before)
    rect = pad_of(drawing)
    drawing.app.draw()
    seen = pygame.surfarray.array3d(drawing.app.canvas.surface)[rect.left : rect.right, rect.top : rect.bottom]
    assert (np.abs(seen.astype(int) - INK).max(axis=2) < 8).mean() > 0.05


@pytest.mark.parametrize(
    "drawn",
    [
        [np.array([(0.5, 0.5)])],
        [np.array([(0.1, 0.5), (0.9, 0.5)])],
        [np.array([(0.5, 0.5), (0.52, 0.51)])],
        [np.random.default_rng(4).random((40, 2))],
    ],
    ids=["dot", "line across", "tick", "scribble"],
)
def test_what_is_no_digit_makes_it_unsure(drawing: Driver, drawn):
    draw(drawing, drawn)
    assert guess(drawing) in range(10)
    for name in ("modern", "classic"):
        assert scene(drawing).reading.verdict(name) is Verdict.UNSURE
    drawing.frames(5)


def test_strokes_beside_the_pad_are_nothing(drawing: Driver):
    for point in ((700, 650), (-5, -5), (2000, 3000)):
        drawing.post(pygame.MOUSEBUTTONDOWN, pos=point, button=1)
        drawing.post(pygame.MOUSEMOTION, pos=(300, 300), rel=(0, 0), buttons=(1, 0, 0))
        drawing.post(pygame.MOUSEBUTTONUP, pos=(300, 300), button=1)
    assert scene(drawing).probabilities is None
    assert scene(drawing).reading.verdict("modern") is Verdict.EMPTY


def test_undo_and_clear_by_keys_words_and_pad(drawing: Driver):
    pad = scene(drawing).pad
    draw(drawing, strokes(4))
    assert len(pad.strokes) == 2
    drawing.key(pygame.K_z)
    assert len(pad.strokes) == 1
    drawing.press_on("Undo")
    assert pad.empty
    draw(drawing, strokes(4))
    drawing.press_on("Clear")
    assert scene(drawing).probabilities is None
    drawing.button(pygame.CONTROLLER_BUTTON_Y)
    assert len(pad.strokes) == 2
    drawing.button(pygame.CONTROLLER_BUTTON_X)
    assert pad.empty


def test_the_network_that_is_looked_into_is_chosen_by_mouse_keys_and_pad(drawing: Driver):
    draw(drawing, strokes(5))
    seen = {}
    for press in (lambda: drawing.key(pygame.K_n), lambda: drawing.button(pygame.CONTROLLER_BUTTON_RIGHTSHOULDER)):
        press()
        seen[scene(drawing).chosen] = scene(drawing).live.why
    assert list(seen) == ["classic", "modern"]
    assert not np.array_equal(seen["classic"], seen["modern"])
    tabs = drawing.choice("Classic")
    drawing.click(tabs._places[1].center)
    assert scene(drawing).chosen == "classic"


def test_saliency_shows_what_ink_speaks_for_the_answer(drawing: Driver):
    draw(drawing, strokes(2))
    drawing.frames(2)  # it is read in the frame after, and then explained
    why, seen = scene(drawing).live.why, scene(drawing).reading.stages.centred
    assert why is not None
    assert np.abs(why).max() == pytest.approx(1)
    assert np.abs(why[seen == 0]).max() == 0


def test_what_is_put_right_is_what_is_drawn_however_soon_that_is(drawing: Driver, monkeypatch):
    digits, given = scene(drawing), []
    monkeypatch.setattr(digits.fixing, "begin", lambda _, image, *others: given.append((image, *others)))
    draw(drawing, strokes(2))
    drawing.key(pygame.K_7)  # it has not been read yet
    [(image, digit, _)] = given
    assert digit == 7
    assert np.array_equal(image, preprocess_strokes(digits.pad.strokes))


def test_a_step_that_is_switched_off_changes_what_is_seen_and_is_put_back(drawing: Driver):
    digits = scene(drawing)
    draw(drawing, strokes(7, 0, 0.3, (0.05, 0.05)))
    drawing.frames(1)
    before = digits.reading.stages.centred
    drawing.press_on(texts.DIGITS_SEES)
    for step in texts.DIGITS_STAGES.values():
        switch = drawing.widget(step)
        drawing.click(switch.box.center)
        assert not np.array_equal(digits.reading.stages.centred, before), step
        drawing.click(switch.box.center)
        assert np.array_equal(digits.reading.stages.centred, before), step


@pytest.mark.parametrize(("word", "name"), [("Look inside", "DigitInsideScene"), ("Why not …?", "WhyNotScene")])
def test_words_lead_further_in_once_there_is_a_drawing(drawing: Driver, word: str, name: str):
    drawing.press_on(word)
    assert drawing.top_name == "DigitsScene"
    drawing.frames(2)
    assert drawing.said == texts.DIGITS_EMPTY
    draw(drawing, strokes(6))
    drawing.click(drawing.widget(word).box.center)
    assert drawing.top_name == name
    drawing.frames(3)
    drawing.key(pygame.K_ESCAPE)
    assert drawing.top_name == "DigitsScene"


def test_a_damaged_network_is_named_and_the_other_one_reads(open_game: Open, context: Context, tmp_path):
    shutil.copytree(context.models_dir / "digits", tmp_path / "models" / "digits")
    (tmp_path / "models" / "digits" / "modern" / "config.json").write_text("{", encoding="utf-8")
    context.models_dir = tmp_path / "models"
    driver = open_game(DigitsScene)
    assert scene(driver).chosen == "classic"
    assert "config.json" in scene(driver).live.reader.problems["modern"]
    driver.key(pygame.K_n)
    assert scene(driver).chosen == "classic"
    draw(driver, strokes(3))
    assert guess(driver) == 3
    driver.frames(3)


def test_without_any_network_there_is_a_pad_and_a_message(open_game: Open, context: Context, tmp_path):
    context.models_dir = tmp_path
    driver = open_game(DigitsScene)
    draw(driver, strokes(3))
    driver.keys(pygame.K_n, pygame.K_3)
    assert scene(driver).probabilities is None
    assert set(scene(driver).live.reader.problems) == {"modern", "classic"}
    assert driver.top_name == "DigitsScene"


def test_a_fix_is_learnt_in_the_background_shown_and_undone(drawing: Driver, context: Context, monkeypatch):
    monkeypatch.setattr("game.scenes.digits.fixing.fix", biased_fix)
    digits = scene(drawing)
    draw(drawing, strokes(1, 1))
    assert guess(drawing) == 1
    drawing.key(pygame.K_7)
    assert digits.fixing.busy
    wait_for(drawing, lambda: not digits.fixing.busy)
    assert guess(drawing) == 7
    assert digits.fixing.fixed.digit == 7
    drawing.frames(2)
    assert (context.user_dir / "digits" / "modern").is_dir()
    word = next(widget for widget in digits.form.widgets if widget.label == "Undo the fix")
    drawing.click(word.box.center)
    assert guess(drawing) == 1
    assert word not in digits.form.widgets


@pytest.mark.parametrize(
    ("word", "name"), [("Quiz", "QuizScene"), ("Train", "DigitTrainingScene"), ("Dream", "DreamScene")]
)
def test_words_lead_to_the_other_screens_and_the_drawing_is_kept(drawing: Driver, word: str, name: str):
    draw(drawing, strokes(6))
    digits = scene(drawing)
    widget = next(widget for widget in digits.form.widgets if widget.label == word)
    drawing.click(widget.box.center)
    assert drawing.top_name == name
    drawing.key(pygame.K_ESCAPE)
    while drawing.top is not digits and "PauseScene" in drawing.top_name:
        drawing.keys(pygame.K_UP, pygame.K_RETURN)  # Leave
    assert drawing.top is digits
    assert guess(drawing) == 6
