"""Training of a digit network: a run, its settings, and what it saves."""

from typing import Any

import numpy as np
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.config import DIGIT_PRESETS, DigitConfig, build_digit_network
from ai.digits.mnist import load_part
from ai.digits.training import DigitTraining
from ai.files.folder import STATE_FILE
from ai.nn import ModelFormatError
from ai.training.run import resume, save

SMALL = DIGIT_PRESETS["classic"].changed(hidden=(16,), epochs=3, held_out=100, batch_size=50, ema_decay=0.9)


@pytest.fixture(scope="module")
def data():
    """600 images: enough to see a network learn."""
    images, labels = load_part("test")
    return images[:600], labels[:600]


def test_a_run_learns_and_reports_how_it_stands(data):
    training = DigitTraining(SMALL, 1, data)
    progress = [training.advance() for _ in range(training.steps)]
    assert training.done
    assert [one.step for one in progress] == list(range(1, 31))
    assert progress[-1].epoch == 3
    assert training.steps == 30
    assert [each["epoch"] for each in training.history] == [1, 2, 3]
    assert np.mean([one.loss for one in progress[-5:]]) < 0.9 * np.mean([one.loss for one in progress[:5]])
    assert training.best == max(each["held_out"] for each in training.history)
    assert progress[0].learning_rate < progress[8].learning_rate > progress[-1].learning_rate


def test_live_knobs_are_taken_over_and_the_others_stay_and_held_out_images_are_never_learnt_from(data):
    training = DigitTraining(SMALL, data=data)
    training.apply_live(SMALL.changed(learning_rate=1e-5, final_learning_rate=1e-6, hidden=(3,)))
    assert training.advance().learning_rate <= 1e-5
    assert training.config.hidden == SMALL.hidden
    assert len(training.images) == 500
    learnt = {image.tobytes() for image in training.images}
    assert not [image for image in training.held_images if image.tobytes() in learnt]
    with pytest.raises(ValueError, match="leaves none"):
        DigitTraining(SMALL.changed(held_out=600), data=data)


def test_a_young_average_follows_faster(data):
    training = DigitTraining(SMALL, data=data)
    for step in (1, 2):
        before, keep = training.average.copy(), step / (step + 10)
        training.advance()
        values = training.classifier.network.values
        np.testing.assert_allclose(training.average, keep * before + (1 - keep) * values, atol=1e-6)


def test_a_resumed_run_goes_on_as_if_it_had_never_stopped(data, tmp_path):
    config = SMALL.changed(dropout=0.3)
    whole, first = DigitTraining(config, 5, data), DigitTraining(config, 5, data)
    for _ in range(13):
        first.advance()
    save(first, tmp_path / "run")
    second = resume(DigitTraining, tmp_path / "run", data=data)
    for training in (whole, second):
        while not training.done:
            training.advance()
    np.testing.assert_array_equal(whole.classifier.network.values, second.classifier.network.values)
    np.testing.assert_allclose(whole.average, second.average, atol=1e-7)
    assert whole.best == second.best


def test_a_run_that_cannot_go_on_says_so(data, tmp_path):
    training = DigitTraining(SMALL, data=data)
    training.advance()
    save(training, tmp_path / "run")
    state = tmp_path / "run" / STATE_FILE
    state.write_bytes(b"nothing")
    with pytest.raises(ModelFormatError, match="without which"):
        resume(DigitTraining, tmp_path / "run", data=data)
    state.unlink()
    with pytest.raises(ModelFormatError, match="nothing to go on with"):
        resume(DigitTraining, tmp_path / "run", data=data)


def test_a_gradient_that_is_not_finite_ends_the_run(data):
    training = DigitTraining(SMALL, data=data)
    training.classifier.network.values[:] = np.nan
    with pytest.raises(FloatingPointError, match=r"the cost was not finite at learning step 1; .* learning rate"):
        training.advance()


def test_presets_build_networks_of_ten_outputs_and_classic_is_the_network_as_first_described():
    networks = {name: build_digit_network(preset, np.random.default_rng(0)) for name, preset in DIGIT_PRESETS.items()}
    for network in networks.values():
        assert DigitClassifier(network).predict(np.zeros((2, 28, 28))).shape == (2, 10)
    layers: Any = networks["classic"].layers
    assert [layer.outputs for layer in layers if layer.outputs] == [100, 50, 10]
    assert [layer.activation.name for layer in layers if hasattr(layer, "activation")] == ["tanh"] * 3
    assert networks["classic"].cost.name == "mse"


def test_every_setting_is_explained_in_a_group_that_a_sweep_can_name():
    for item in DigitConfig.__dataclass_fields__.values():
        assert item.metadata["help"].endswith(".")
        assert item.metadata["group"] in ("learning", "network", "images")


def test_a_batch_cannot_ask_for_more_memory_than_there_is_and_windows_have_to_fit():
    for wrong in ({"batch_size": 5000}, {"batch_size": 100, "filters": (256,), "kernel": 1}):
        with pytest.raises(ValueError, match="batch_size is at most"):
            DigitConfig(**wrong)
    DIGIT_PRESETS["classic"].changed(batch_size=5000)
    with pytest.raises(ValueError, match="a kernel of 9 does not fit"):
        DigitConfig(filters=(16, 16, 16), kernel=9)
