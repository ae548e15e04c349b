import numpy as np
import pytest

from ai.digits.config import DIGIT_PRESETS, build_digit_network
from ai.explain.excited import MostExciting
from ai.explain.unit_sums import stages

SMALL = DIGIT_PRESETS["modern"].changed(filters=(4, 5), kernel=3)


@pytest.mark.parametrize("number", [0, 3])
def test_the_patch_is_where_of_all_images_the_filter_gives_most(number: int):
    rng = np.random.default_rng(0)
    network, images = build_digit_network(SMALL, rng), rng.random((7, 28, 28), np.float32)
    passes = [stages(network, image[..., None]) for image in images]
    search = MostExciting(network, passes[0][: number + 1], images)
    while not search.done:
        search.go_on(3)
    for unit in range(passes[0][number].outputs.shape[2]):
        best = max(range(7), key=lambda at: passes[at][number].outputs[..., unit].max())
        highest = passes[best][number].outputs[..., unit].max()
        assert search.most[unit] == pytest.approx(float(highest), rel=1e-5)
        patch = search.patches[unit]
        assert patch.shape == ((3, 3) if number == 0 else (8, 8))
        windows = np.lib.stride_tricks.sliding_window_view(images[best], patch.shape)
        assert (windows == patch).all(axis=(2, 3)).any(), "it is ink of that image"
