"""Paths of the shipped data, which lies beside the packages both in a checkout and in an installed wheel."""

from __future__ import annotations

from pathlib import Path
from typing import Final

_ROOT: Final = Path(__file__).resolve().parents[2]
ASSETS_DIR: Final = _ROOT / "assets"
MODELS_DIR: Final = _ROOT / "models"
MICROLANDER: Final = _ROOT / "examples" / "microlander.py"
