import json
from itertools import product

import numpy as np
import pytest

from ai.digits import DigitClassifier, MnistError, load_mnist, preprocess
from ai.digits.mnist import FOLDER, load_part
from ai.digits.preprocessing import preprocess_strokes, stages
from ai.digits.strokes import draw_strokes
from ai.nn import (
    ActivationFunctions,
    ActivationLayer,
    CostFunctions,
    FullyConnectedLayer,
    ModelFormatError,
    NeuralNetwork,
)

MODELS = FOLDER.parents[1] / "models" / "digits"
SEVEN = np.array([(0, 0), (100, 0), (40, 160)])  # wider above: its centre of mass is not that of its box


@pytest.fixture(scope="module")
def test_part():
    return load_part("test")


def seven(size=520, at=(150, 130), scale=1.5, pen=25.0):
    return draw_strokes([SEVEN * scale + at], (size, size), pen)


def centre_of_mass(image):
    place = np.arange(len(image))
    return image.sum(axis=1) @ place / image.sum(), image.sum(axis=0) @ place / image.sum()


def spans(image, ink=0.1):
    """Height and width of the ink, in pixels."""
    return tuple(int(np.ptp(np.flatnonzero((image > ink).any(axis=axis)))) + 1 for axis in (1, 0))


# Data


@pytest.mark.slow
def test_all_of_mnist_is_there():
    train_images, train_labels, test_images, test_labels = load_mnist()
    assert train_images.shape == (60000, 28, 28)
    assert test_images.shape == (10000, 28, 28)
    assert train_images.dtype == test_images.dtype == np.float32
    assert train_images.min() == 0.0
    assert train_images.max() == 1.0
    assert train_images[:, 0, 0].max() == 0.0, "ink is bright, paper is dark"
    assert train_labels[:5].tolist() == [5, 0, 4, 1, 9]
    assert np.bincount(test_labels).tolist() == [980, 1135, 1032, 1010, 982, 892, 958, 1028, 974, 1009]


def one_pixel_off(path):
    with np.load(FOLDER / "test.npz") as arrays:
        images, labels = arrays["images"].copy(), arrays["labels"]
    images[0, 0, 0] = 1
    np.savez(path, images=images, labels=labels)


DAMAGE = {
    "missing": lambda path: None,
    "cut short": lambda path: path.write_bytes((FOLDER / "test.npz").read_bytes()[:5000]),
    "another array": lambda path: np.savez(path, images=np.zeros(3), labels=np.zeros(3)),
    "no labels": lambda path: np.savez(path, images=np.zeros(3)),
    "one pixel off": one_pixel_off,
    "a folder": lambda path: path.mkdir(),
}


def test_damaged_data_are_named(tmp_path):
    for number, damage in enumerate(DAMAGE.values()):
        folder = tmp_path / str(number)
        folder.mkdir()
        damage(folder / "test.npz")
        with pytest.raises(MnistError, match=r"MNIST: .*test\.npz is (damaged|missing).*install") as caught:
            load_part("test", folder)
        assert isinstance(caught.value, ValueError)


# Preprocessing


def test_centre_of_mass_is_the_middle_of_pixel_14():
    for at, scale in product(((20, 30), (150, 130), (300, 180)), (0.3, 1.0, 2.0)):
        image = preprocess(seven(at=at, scale=scale, pen=10))
        assert (image.shape, image.dtype) == ((28, 28), np.float32)
        assert 0.0 <= image.min() <= image.max() <= 1.0
        assert centre_of_mass(image) == pytest.approx((14, 14), abs=0.05), (at, scale)


def test_ink_fits_the_box_and_keeps_its_aspect():
    for stretch in ((1, 1), (0.4, 1), (1, 0.4)):
        square = np.array([(0, 0), (200, 0), (200, 200), (0, 200), (0, 0)]) * stretch
        drawn = draw_strokes([square + 100], (520, 520), 20)
        height, width = spans(preprocess(drawn), ink=0.5)
        assert max(height, width) in (19, 20, 21)
        assert (width - 2.4) / (height - 2.4) == pytest.approx(stretch[0] / stretch[1], rel=0.1)
        fitted = stages(drawn).fitted
        assert fitted.shape == (20, 20)
        assert max(spans(fitted)) == 20


def test_it_does_not_matter_where_and_how_large_a_digit_is_drawn():
    reference = preprocess(seven())
    for same in (
        seven(at=(20, 200)),
        seven(at=(100, 100), scale=1.0, pen=25 / 1.5),
        seven(size=280, at=(50, 40), scale=0.75, pen=12.5),
        seven(size=900),
        np.pad(seven(), ((0, 80), (300, 0))),
    ):
        assert np.abs(preprocess(same) - reference).mean() < 0.015


def test_pens_of_all_widths_look_alike():
    reference = preprocess(seven(pen=25))
    for pen in (4, 10, 16, 40, 50):
        image = preprocess(seven(pen=pen))
        assert image.sum() == pytest.approx(reference.sum(), rel=0.2)
        assert np.corrcoef(image.ravel(), reference.ravel())[0, 1] > 0.9
    raw = [stages(seven(pen=pen), width=False).centred.sum() for pen in (10, 50)]
    assert raw[1] > 2 * raw[0], "without the step they differ"


def test_strokes_and_the_canvas_they_were_drawn_on_look_alike():
    from_strokes = preprocess_strokes([SEVEN])
    assert centre_of_mass(from_strokes) == pytest.approx((14, 14), abs=0.05)
    assert np.corrcoef(from_strokes.ravel(), preprocess(seven()).ravel())[0, 1] > 0.95
    assert preprocess_strokes([]).max() == 0
    assert preprocess_strokes([[(np.nan, 3)], []]).max() == 0
    assert preprocess_strokes([[(5, 5)]]).max() > 0.5
    with pytest.raises(ValueError, match="a stroke is"):
        preprocess_strokes([[1, 2, 3]])


def test_number_types_and_ranges_do_not_matter():
    canvas = (seven() > 0.5).astype(np.float32)
    for same in (
        canvas > 0,
        canvas.astype(np.int64),
        (canvas * 255).astype(np.uint8),
        canvas * 1e30,
        canvas - 5 * (1 - canvas),
    ):
        np.testing.assert_allclose(preprocess(same), preprocess(canvas), atol=1e-5)
    noisy = canvas.copy()
    noisy[0, :3] = np.nan, -np.inf, np.nan
    np.testing.assert_allclose(preprocess(noisy), preprocess(canvas), atol=1e-5)


def test_nothing_drawn_is_nothing():
    empty = np.zeros((520, 520)), np.zeros((0, 0)), np.zeros((3, 0)), np.full((9, 9), np.nan), -np.ones((5, 5))
    for canvas in (*empty, [[False]]):
        np.testing.assert_array_equal(preprocess(canvas), np.zeros((28, 28)))
    with pytest.raises(ValueError, match="two axes, not 3"):
        preprocess(np.zeros((4, 4, 3)))


def test_any_canvas_gives_an_image():
    for canvas in (
        np.ones((1, 1)), np.ones((300, 200)), np.ones((1, 500)), np.eye(2), np.array([[np.inf, 1e308]]),
        np.random.default_rng(0).random((100, 140)), np.pad(np.ones((1, 1)), 200), np.full((40, 40), 1e-30),
    ):  # fmt: skip
        image = preprocess(canvas)
        assert image.shape == (28, 28)
        assert np.isfinite(image).all()
        assert image.max() > 0.2, canvas.shape
        assert centre_of_mass(image) == pytest.approx((14, 14), abs=0.3), canvas.shape
    dot = preprocess(draw_strokes([[(200, 90)]], (520, 520), 24))
    assert max(spans(dot, ink=0.5)) <= 14, "a dot is not blown up to fill the box"


def test_images_of_mnist_come_back_nearly_as_they_were(test_part):
    images = test_part[0][:100]
    back = np.stack([preprocess(np.pad(np.kron(image, np.ones((10, 10))), ((40, 9), (0, 90)))) for image in images])
    assert np.abs(back - images).mean() < 0.05
    assert back.mean() == pytest.approx(0.131, rel=0.1), "as much ink as in the mean of all images"
    unchanged = np.stack([stages(image, width=False).centred for image in images])
    assert np.abs(unchanged - images).mean() < 0.035


# Classifier


def small_network(cost=None, inputs=784, outputs=10):
    return (
        NeuralNetwork(*(cost or CostFunctions.use_mse()))
        .add_layer(FullyConnectedLayer(inputs, outputs))
        .add_layer(ActivationLayer(*ActivationFunctions.use_tanh()))
    )


def test_a_classifier_gives_probabilities_and_is_read_back(tmp_path, test_part):
    images = test_part[0][:30]
    for number, cost in enumerate((CostFunctions.use_mse(), CostFunctions.use_softmax_cross_entropy())):
        classifier = DigitClassifier(small_network(cost))
        classifier.save(tmp_path / str(number))
        guess = DigitClassifier.load(tmp_path / str(number)).predict(images)
        assert guess.shape == (30, 10)
        assert (guess >= 0).all()
        np.testing.assert_allclose(guess.sum(axis=1), 1, atol=1e-5)
        np.testing.assert_array_equal(guess, classifier.predict(images))
        np.testing.assert_allclose(classifier.predict(images[0])[0], guess[0], atol=1e-6)
        assert classifier.predict(images[:0]).shape == (0, 10)
    with pytest.raises(ValueError, match="images are"):
        classifier.predict(np.zeros((3, 20, 20)))


def test_networks_of_other_sizes_are_refused(tmp_path):
    with pytest.raises(ValueError, match="not 784 numbers"):
        DigitClassifier(small_network(inputs=9))
    DigitClassifier(small_network(outputs=4)).save(tmp_path / "four")
    with pytest.raises(ModelFormatError, match="10 outputs"):
        DigitClassifier.load(tmp_path / "four")


def test_a_damaged_folder_is_named(tmp_path):
    DigitClassifier(small_network()).save(tmp_path / "model")
    for text, message in (
        ("{", "config.json"), ("[]", "a 'tranquility digits'"), ('{"format": "tranquility digits", "version": 9}', "9"),
    ):  # fmt: skip
        (tmp_path / "model" / "config.json").write_text(text)
        with pytest.raises(ModelFormatError, match=message):
            DigitClassifier.load(tmp_path / "model")
    with pytest.raises(ModelFormatError, match="nowhere"):
        DigitClassifier.load(tmp_path / "nowhere")


def test_shipped_networks_read_the_first_test_images(test_part):
    images, labels = test_part[0][:1000], test_part[1][:1000]
    for name, preset, floor in (("classic", "classic", 0.97), ("modern", "thorough", 0.99)):
        classifier = DigitClassifier.load(MODELS / name)
        assert (classifier.predict(images).argmax(axis=1) == labels).mean() >= floor
        described = json.loads((MODELS / name / "training.json").read_text())
        assert (described["preset"], described["changes"]) == (preset, {})
        assert described["test"] >= floor


def test_the_shipped_modern_network_reads_ones_with_long_flags():
    """As they are written in much of Europe; one that learned from MNIST alone took most of them for sevens."""
    flags = [[(0, 48), (70, 0), (66, 100)], [(14, 42), (82, 0), (50, 100)], [(10, 34), (40, 12), (62, 0), (62, 100)]]
    read = DigitClassifier.load(MODELS / "modern").predict(np.stack([preprocess_strokes([flag]) for flag in flags]))
    assert read.argmax(axis=1).tolist() == [1, 1, 1]
