import numpy as np
import pytest

from ai.digits.augmentation import Strength, augment
from ai.digits.mnist import load_part


@pytest.fixture(scope="module")
def images():
    return load_part("test")[0][:300]


def centres(images):
    place = np.arange(28)
    mass = images.sum(axis=(1, 2))
    return np.stack([images.sum(axis=2) @ place / mass, images.sum(axis=1) @ place / mass], axis=1)


def test_the_same_seed_gives_the_same_images(images):
    first, again, other = (augment(images, np.random.default_rng(seed)) for seed in (3, 3, 4))
    np.testing.assert_array_equal(first, again)
    assert np.abs(first - other).mean() > 0.02


def test_images_stay_images_and_the_originals_as_they_were(images):
    before = images.copy()
    changed = augment(images, np.random.default_rng(0))
    assert changed.shape == images.shape
    assert changed.dtype == np.float32
    assert 0.0 <= changed.min() <= changed.max() <= 1.0
    np.testing.assert_array_equal(images, before)
    assert np.abs(changed - images).mean(axis=(1, 2)).min() > 0.005, "every one is changed"


def test_changed_images_are_like_preprocessed_ones(images):
    """About as much ink, in the middle, within the box, on black paper."""
    changed = augment(images, np.random.default_rng(0), Strength(shift=0, scale=0))
    assert changed.mean() == pytest.approx(images.mean(), rel=0.1)
    assert np.abs(centres(changed) - 14).max() < 1.2
    assert np.abs(centres(changed) - 14).mean() < 0.3
    rows, columns = (changed > 0.3).any(axis=2).sum(axis=1), (changed > 0.3).any(axis=1).sum(axis=1)
    longer = np.maximum(rows, columns)
    assert 19 < longer.mean() < 21
    assert np.median(changed) == 0.0
    assert changed.max(axis=(1, 2)).min() > 0.8, "ink is ink"


def test_without_strength_little_but_contrast_changes(images):
    same = augment(images, np.random.default_rng(0), Strength().times(0))
    correlation = [np.corrcoef(a.ravel(), b.ravel())[0, 1] for a, b in zip(same, images, strict=True)]
    assert np.mean(correlation) > 0.95


@pytest.mark.parametrize("name", ["rotation", "slant", "aspect", "scale", "shift", "bend", "pen"])
def test_each_change_does_something_of_its_own(images, name):
    none = Strength().times(0)
    alone = Strength(**(vars(none) | {name: getattr(Strength(), name)}))
    still, moved = (augment(images, np.random.default_rng(0), strength) for strength in (none, alone))
    assert np.abs(still - moved).mean() > 0.003


def test_a_thicker_pen_leaves_the_paper_black(images):
    changed = augment(images, np.random.default_rng(0), Strength(0, 0, 0, 0, 0, 0, pen=1.0))
    assert changed[:, 0].max() == 0.0
    share = changed.mean(axis=(1, 2)) / images.mean(axis=(1, 2))
    assert share.min() < 0.9
    assert share.max() > 1.15


def test_no_images_and_empty_ones():
    assert augment(np.zeros((0, 28, 28), np.float32), np.random.default_rng(0)).shape == (0, 28, 28)
    assert augment(np.zeros((3, 28, 28), np.float32), np.random.default_rng(0)).max() == 0.0
