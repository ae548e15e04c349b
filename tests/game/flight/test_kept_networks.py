"""Networks that were read are kept, as long as their files stay as they are."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest

from ai.lander.environment import NUM_FEATURES
from game.core.assets import MODELS_DIR
from game.flight import networks


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A network of the player's own."""
    return Path(shutil.copytree(MODELS_DIR / "lander" / "modern", tmp_path / "mine"))


def test_a_network_is_read_once_whatever_it_is_called(folder: Path):
    first, second = networks.load("mine", folder), networks.load("best", folder)
    assert first.policy is not None
    assert first.policy is second.policy
    assert (first.name, second.name) == ("mine", "best")


def test_it_is_read_again_once_a_file_has_changed_and_not_kept_once_it_is_damaged(folder: Path):
    first = networks.load("mine", folder).policy
    file = folder / "config.json"
    os.utime(file, ns=(1, 1))
    second = networks.load("mine", folder).policy
    assert second is not None
    assert second is not first
    seen = np.zeros((1, NUM_FEATURES), np.float32)
    assert second.act(seen) == first.act(seen)
    whole = file.read_bytes()
    file.write_bytes(whole[: len(whole) // 2])
    assert networks.load("mine", folder).policy is None
    assert networks.load("mine", folder).problem
    file.write_bytes(whole)
    assert networks.load("mine", folder).policy is not None
    shutil.rmtree(folder)
    assert networks.load("mine", folder).policy is None
