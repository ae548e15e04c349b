"""German and Spanish on every screen, at all sizes of text and in four windows: nothing is cut, and nothing meets."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from game.core import catalogue

ROOT = Path(__file__).parents[2]
LANGUAGES = [code for code in catalogue.languages(catalogue.LOCALE) if code != catalogue.ENGLISH]
WINDOWS = "1280x720", "1920x1080", "800x600", "720x1280"


@pytest.mark.slow
@pytest.mark.parametrize("language", LANGUAGES)
def test_every_text_of_a_language_fits_and_meets_no_other(language: str):
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
    walk = json.loads(done.stdout)
    assert len(walk["seen"]) > 500
    assert not walk["wrong"], "\n".join(map(str, walk["wrong"].items()))
