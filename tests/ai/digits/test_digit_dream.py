from pathlib import Path

import numpy as np
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.dream import STEPS, ActivationMaximisation

MODELS = Path(__file__).parents[3] / "models" / "digits"


@pytest.fixture(scope="module", params=["classic", "modern"])
def classifier(request):
    return DigitClassifier.load(MODELS / request.param)


def dreamt(classifier, digit, steps):
    dream = ActivationMaximisation(classifier, digit, np.random.default_rng(0))
    for _ in range(steps):
        dream.advance()
    return dream


def test_the_network_comes_to_read_the_digit_it_dreams_of(classifier):
    dream = dreamt(classifier, 3, 40)
    assert dream.probabilities[3] > 0.5 > dreamt(classifier, 3, 0).probabilities[3]
    np.testing.assert_array_equal(dream.probabilities, classifier.predict(dream.image)[0])


def test_the_gradient_is_that_of_what_is_to_grow(classifier):
    """Against finite differences of the logarithm of the probability, or of the outputs' difference."""
    dream = ActivationMaximisation(classifier, 2, np.random.default_rng(3))
    network = classifier.network

    def worth(image):
        outputs = network.predict(classifier.shaped(image))[0].astype(float)
        if network.cost.logits:
            return outputs[2] - np.log(np.exp(outputs).sum())
        return outputs[2] - np.delete(outputs, 2).mean()

    gradient = dream.gradient(dream.image)
    way = gradient / np.linalg.norm(gradient)
    step = 1e-3  # between two of the kinks that ReLU and pooling make
    rise = (worth(dream.image + step * way) - worth(dream.image - step * way)) / (2 * step)
    assert rise == pytest.approx(np.linalg.norm(gradient), rel=0.03)


def test_it_comes_to_an_end():
    classifier = DigitClassifier.load(MODELS / "classic")
    dream = dreamt(classifier, 1, STEPS)
    assert dream.done
    assert 0 <= dream.image.min() <= dream.image.max() <= 1
    with pytest.raises(ValueError, match="from 0 to 9"):
        ActivationMaximisation(classifier, 10, np.random.default_rng(0))
