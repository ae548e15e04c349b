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


def test_images_stay_images_like_preprocessed_ones_and_the_originals_as_they_were(images):
    """About as much ink, in the middle, within the box, on black paper."""
    before = images.copy()
    changed = augment(images, np.random.default_rng(0), Strength(shift=0, scale=0))
    assert (changed.shape, changed.dtype) == (images.shape, np.float32)
    assert 0.0 <= changed.min() <= changed.max() <= 1.0
    np.testing.assert_array_equal(images, before)
    assert np.abs(changed - images).mean(axis=(1, 2)).min() > 0.005, "every one is changed"
    assert changed.mean() == pytest.approx(images.mean(), rel=0.1)
    away = np.abs(centres(changed) - 14)
    assert away.max() < 1.2
    assert away.mean() < 0.3
    rows, columns = (changed > 0.3).any(axis=2).sum(axis=1), (changed > 0.3).any(axis=1).sum(axis=1)
    assert 19 < np.maximum(rows, columns).mean() < 21
    assert np.median(changed) == 0.0
    assert changed.max(axis=(1, 2)).min() > 0.8, "ink is ink"
    assert augment(images[:0], np.random.default_rng(0)).shape == (0, 28, 28)
    assert augment(np.zeros((3, 28, 28), np.float32), np.random.default_rng(0)).max() == 0.0


def test_each_change_does_something_of_its_own(images):
    none = Strength().times(0)
    still = augment(images, np.random.default_rng(0), none)
    correlation = [np.corrcoef(a.ravel(), b.ravel())[0, 1] for a, b in zip(still, images, strict=True)]
    assert np.mean(correlation) > 0.95, "without strength, little but contrast changes"
    for name in ("rotation", "slant", "aspect", "scale", "shift", "bend", "pen"):
        alone = Strength(**(vars(none) | {name: getattr(Strength(), name)}))
        assert np.abs(still - augment(images, np.random.default_rng(0), alone)).mean() > 0.003, name


def test_a_thicker_pen_leaves_the_paper_black(images):
    changed = augment(images, np.random.default_rng(0), Strength(0, 0, 0, 0, 0, 0, pen=1.0))
    assert changed[:, 0].max() == 0.0
    share = changed.mean(axis=(1, 2)) / images.mean(axis=(1, 2))
    assert share.min() < 0.9
    assert share.max() > 1.15
