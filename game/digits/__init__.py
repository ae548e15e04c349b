"""Drawing digits: the pad, what a network reads of it, and pictures of how it knows."""

from typing import Final

PATIENCE: Final = 120.0  # seconds for a worker's turn: reading all test images in one takes a busy machine long
