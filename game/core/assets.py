"""Paths of the shipped data, which lies beside the packages both in a checkout and in an installed wheel."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

_ROOT: Final = Path(__file__).resolve().parents[2]
ASSETS_DIR: Final = _ROOT / "assets"
MODELS_DIR: Final = _ROOT / "models"
PACKED: Final = bool(getattr(sys, "frozen", False))  # whether this is the app, to which nothing can be installed
