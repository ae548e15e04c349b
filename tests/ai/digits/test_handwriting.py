import numpy as np

from ai.digits.config import DIGIT_PRESETS
from ai.digits.handwriting import STYLES, crossed, drawings, written
from ai.digits.preprocessing import preprocess_strokes
from ai.digits.training import DigitTraining

CONFIG = DIGIT_PRESETS["classic"].changed(hidden=(8,), epochs=1, held_out=20, batch_size=40, unaugmented=0.0)


def test_the_same_seed_writes_the_same_digits():
    first, again, other = (drawings(np.arange(10), np.random.default_rng(seed)) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert (np.abs(first - other).mean(axis=(1, 2)) > 0.02).all()


def test_hands_write_what_a_mouse_could_tell():
    for digit in range(10):
        rng = np.random.default_rng(digit)
        for _ in range(20):
            strokes = written(digit, rng)
            points = np.concatenate(strokes)
            assert all(len(stroke) >= 4 for stroke in strokes), digit
            np.testing.assert_array_equal(points, np.rint(points))
            width, height = np.ptp(points, axis=0)
            assert 30 < height < 600, digit
            assert 0 < width < 600, digit


def test_drawings_are_what_a_network_would_read_of_the_strokes():
    strokes = written(7, np.random.default_rng(5))
    np.testing.assert_array_equal(drawings(np.array([7]), np.random.default_rng(5))[0], preprocess_strokes(strokes))
    assert drawings(np.array([], int), np.random.default_rng(0)).shape == (0, 28, 28)


def test_zeros_are_crossed_in_all_directions_inside_and_beyond_the_ring():
    rng, ring = np.random.default_rng(4), STYLES[0][0]
    angles, beyond, in_one, twice = [], [], 0, 0
    for _ in range(200):
        style = crossed(ring, rng)
        in_one += len(style[0]) > len(ring[0])
        twice += len(style) - len(ring) + (len(style[0]) > len(ring[0])) == 2
        ends = np.array(style[1] if len(style[0]) == len(ring[0]) else (style[0][-2], style[0][-1]))
        across, down = ends[1] - ends[0]
        angles.append(np.degrees(np.arctan2(-down, across)) % 180)
        beyond.append(int((np.hypot(*(ends - 50).T) > 60).sum()))
    assert {round(angle / 45) % 4 for angle in angles} == {0, 1, 2, 3}
    assert set(beyond) == {0, 1, 2}, "inside, out on one side, out on both"
    assert 30 < in_one < 70
    assert 10 < twice < 40


def test_some_digits_are_narrow_and_zeros_and_eights_oftenest():
    def narrow(digit: int) -> float:
        rng = np.random.default_rng(digit)
        sizes = [np.ptp(np.concatenate(written(digit, rng)), axis=0) for _ in range(200)]
        return float(np.mean([width < 0.3 * height for width, height in sizes]))

    assert min(narrow(0), narrow(8)) > 0.1
    assert 0.0 < max(narrow(2), narrow(3)) < 0.1


def test_a_run_learns_from_hands_as_often_as_asked_and_keeps_the_labels():
    """Blank images stay blank but for those that a hand has drawn."""
    labels = np.arange(420, dtype=np.uint8) % 10
    blank = np.zeros((420, 28, 28), np.float32)
    training = DigitTraining(CONFIG.changed(drawn=0.25), 3, (blank, labels))
    seen = []
    training.classifier.shaped = lambda images: seen.append(images.copy()) or images.reshape(-1, 784)
    for _ in range(training.steps_per_epoch - 1):
        training.advance()
    written_on = np.concatenate(seen).any(axis=(1, 2))
    assert 0.15 < written_on.mean() < 0.35
    assert not training.images.any(), "the images themselves stay as they are"
