"""German and Spanish on every screen, at all sizes of text and in three windows: nothing is cut, and nothing meets."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from game.core import catalogue

ROOT = Path(__file__).parents[2]
WINDOWS = "800x600", "720x1280"  # beside the usual one; larger ones of its shape are laid out alike


def walked(language: str) -> dict[str, dict[str, str]]:
    """Walk through all screens in a language; return what was seen, and what was misplaced, each with where."""
    done = subprocess.run(
        [sys.executable, "-m", "tests.support.pseudo_walk", str(catalogue.LOCALE), *WINDOWS],
        cwd=ROOT,
        env=os.environ | {"LANGUAGE": language, "OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=False,
        timeout=1800,
    )
    assert done.returncode == 0, done.stderr
    walk: dict[str, dict[str, str]] = json.loads(done.stdout)
    return walk


@pytest.mark.slow
def test_no_text_of_a_language_is_misplaced_where_english_is_not(subtests: pytest.Subtests):
    """Where English has too little room as well, the screen is to be mended, and not the translation."""
    known = set(walked(catalogue.ENGLISH)["wrong"].values())
    for language in sorted({*catalogue.languages(catalogue.LOCALE)} - {catalogue.ENGLISH}):
        with subtests.test(language=language):
            walk = walked(language)
            assert len(walk["seen"]) > 500
            wrong = {text: place for text, place in walk["wrong"].items() if place not in known}
            assert not wrong, "\n".join(map(str, wrong.items()))
