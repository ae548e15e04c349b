"""Why not another digit: what is said of ink and of units is what the network itself answers."""

from itertools import product

import numpy as np
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.config import DIGIT_PRESETS, build_digit_network
from ai.digits.mnist import load_part
from ai.explain.contrast import Contrast
from ai.nn import CostFunctions, FullyConnectedLayer, LayerNormalisation, NeuralNetwork
from game.core.assets import MODELS_DIR

SMALL = DIGIT_PRESETS["modern"].changed(filters=(4, 5), kernel=3)


@pytest.fixture(scope="module", params=["convolution", "classic"])
def classifier(request):
    if request.param == "classic":
        return DigitClassifier.load(MODELS_DIR / "digits" / "classic")
    return DigitClassifier(build_digit_network(SMALL, np.random.default_rng(0)))


@pytest.fixture(scope="module")
def contrast(classifier):
    contrast = Contrast(classifier, load_part("test")[0][8])
    while contrast.left:
        contrast.advance()
    return contrast


def scores(classifier, images):
    network = classifier.network
    at = max(number for number, layer in enumerate(network.layers) if layer.parameters)
    return network.activations(classifier.shaped(images))[at].squeeze()


def test_ink_that_is_named_really_raises_the_score_when_it_is_taken_away_or_put_there(classifier, contrast):
    image, named = contrast.image, 0
    assert contrast.answer == int(classifier.predict(image).argmax())
    before = scores(classifier, image)
    for asked, ink in product(set(range(10)) - {contrast.answer}, (0, 1)):
        if change := contrast.best(asked, ink):
            named += 1
            other = contrast.changed(change.row, change.column, ink)
            after = scores(classifier, other)
            assert after[asked] > before[asked]
            assert (change.before, change.after) == pytest.approx((before[asked], after[asked]), abs=1e-4)
            assert (other != image).sum() <= 9
            assert other.sum() > image.sum() if ink else other.sum() < image.sum()
    assert named > 10


def test_no_other_square_would_do_more(classifier, contrast):
    asked = (contrast.answer + 3) % 10
    best = contrast.best(asked, 0)
    gain = best.after - best.before - contrast.taken[best.row, best.column, contrast.answer]
    places = [place for place in np.ndindex(28, 28) if not np.isnan(contrast.taken[place][0])]
    changes = scores(classifier, np.stack([contrast.changed(*place, 0) for place in places])) - contrast.scores
    raised = changes[changes[:, asked] > 1e-4]
    assert (raised[:, asked] - raised[:, contrast.answer] <= gain + 1e-4).all()
    assert len(raised) > 1


def test_what_is_named_early_is_true_before_all_is_measured(classifier):
    image = load_part("test")[0][4]
    contrast = Contrast(classifier, image)
    assert contrast.best(7, 0) is None
    contrast.advance()
    assert contrast.left
    measured_now = int(np.isfinite(contrast.taken[..., 0]).sum())
    assert measured_now == contrast.batch
    ink = np.lib.stride_tricks.sliding_window_view(np.pad(image, 1), (3, 3)).sum(axis=(2, 3))
    early = np.isfinite(contrast.taken[..., 0])  # the squares with the most ink come first
    assert ink[early].min() >= ink[~early].max() - 1e-4
    if change := contrast.best(7, 0):
        assert scores(classifier, contrast.changed(change.row, change.column, 0))[7] > scores(classifier, image)[7]


def test_an_empty_image_has_nothing_to_say_and_a_strange_network_is_refused(classifier):
    empty = Contrast(classifier, np.zeros((28, 28), np.float32))
    assert not empty.left
    assert empty.best(3, 0) is None
    network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(FullyConnectedLayer(784, 10))
    network.add_layer(LayerNormalisation(10))
    with pytest.raises(ValueError, match="ten outputs"):
        Contrast(DigitClassifier(network), np.ones((28, 28), np.float32))
