from pathlib import Path

import numpy as np
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.fix import COPIES, ENOUGH, STEPS, Fixed, FixStep, fix
from ai.digits.mnist import load_part
from ai.nn import NeuralNetwork

CLASSIC = Path(__file__).parents[3] / "models" / "digits" / "classic"


@pytest.fixture(scope="module")
def data():
    images, labels = load_part("test")
    return images[:1000], labels[:1000]


@pytest.fixture(scope="module")
def misread(data):
    """An image that the network misreads, and what it is."""
    images, labels = data
    wrong = np.flatnonzero(DigitClassifier.load(CLASSIC).predict(images).argmax(axis=1) != labels)
    return images[wrong[0]], int(labels[wrong[0]])


def fixed(data, misread, keep) -> Fixed:
    image, digit = misread
    messages = [each for message in fix(CLASSIC, image, digit, keep, train=data, test=data) for each in message]
    assert all(isinstance(each, FixStep) for each in messages[:-1])
    assert isinstance(messages[-1], Fixed)
    return messages[-1]


def test_a_fix_teaches_the_drawing_says_what_it_cost_and_is_kept(tmp_path, data, misread):
    image, digit = misread
    done = fixed(data, misread, tmp_path / "fixed")
    before, after = done.probability
    assert before < 0.5 < ENOUGH - 0.05 < after
    assert 0 < done.steps <= STEPS
    assert done.accuracy[0] > 0.97
    assert done.accuracy[1] > 0.95  # it has not forgotten the others
    kept = DigitClassifier.load(tmp_path / "fixed")
    assert kept.predict(image)[0].argmax() == digit
    assert DigitClassifier.load(CLASSIC).predict(image)[0].argmax() != digit
    right = (kept.predict(data[0]).argmax(axis=1) == data[1]).mean()
    assert right == pytest.approx(done.accuracy[1])


def test_what_it_is_sure_of_already_changes_nothing(tmp_path, data):
    images, labels = data
    sure = np.flatnonzero(DigitClassifier.load(CLASSIC).predict(images)[np.arange(len(labels)), labels] > 0.95)[0]
    done = fixed(data, (images[sure], int(labels[sure])), tmp_path / "fixed")
    assert (done.steps, done.folder) == (0, None)
    assert done.accuracy == (0.9861, 0.9861), "what is known of the network is not measured again"
    assert not (tmp_path / "fixed").exists()


def test_a_fix_that_cannot_be_kept_says_why(tmp_path, data, misread):
    (tmp_path / "file").write_text("in the way")
    done = fixed(data, misread, tmp_path / "file" / "fixed")
    assert done.folder is None
    assert done.problem


def test_what_is_no_drawing_or_no_digit_is_refused(tmp_path, data):
    ones = np.ones((28, 28))
    for image, digit in ((0 * ones, 3), (np.nan * ones, 3), (ones, 10), (ones, -1)):
        with pytest.raises(ValueError, match=r"digit|learn"):
            list(fix(CLASSIC, image, digit, tmp_path, train=data, test=data))


def test_it_learns_the_drawing_as_it_is_and_bent_in_other_ways(tmp_path, data, misread, monkeypatch):
    batches, train = [], NeuralNetwork.train_batch
    monkeypatch.setattr(
        NeuralNetwork, "train_batch", lambda network, x, *given: batches.append(x) or train(network, x, *given)
    )
    fixed(data, misread, tmp_path / "fixed")
    for batch in batches:
        copies = batch.reshape(len(batch), -1)[:COPIES]
        assert np.array_equal(copies[0], misread[0].ravel())
        assert len(np.unique(copies, axis=0)) == COPIES
