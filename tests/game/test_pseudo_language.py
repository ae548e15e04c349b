"""Every scene in a language that nobody speaks: all that is written is translated, and fits, at all sizes of text."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pygame
import pytest

from game.core import texts
from tests.support import pseudo
from tests.support.written import Note, Page, misplaced

ROOT = Path(__file__).parents[2]
# What is the same in every language: units, and keys that are named by their letter or number.
UNITS = {"m", "s", "ms", "min", "k", "M"}
KEY = re.compile(r"[A-Z]|F\d+")
# Names of languages, of networks, of errors in Python, and of what the tests ask in their own dialogs.
NAMES = {"English", "modern", "classic", "anywhere", "mine", "ValueError", "a", "b", "yes", "no", "name"}
FOLDERS = {"ai", "engine", "examples"}  # of our own code, whose lines some screens show
PATH = re.compile(r"/\S*")
TINY = re.compile(r"\d+e[-−]\d+")  # a number: 5e-05


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, str]]:
    folder = tmp_path_factory.mktemp("locale")
    pseudo.make(folder)
    done = subprocess.run(
        [sys.executable, "-m", "tests.support.pseudo_walk", str(folder)],
        cwd=ROOT,
        env=os.environ | {"LANGUAGE": pseudo.CODE, "LANG": "en_US.UTF-8", "OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=False,
        timeout=1800,  # it takes a minute, and many on a busy machine
    )
    assert done.returncode == 0, done.stderr
    walked: dict[str, dict[str, str]] = json.loads(done.stdout)
    return walked


def english(text: str) -> set[str]:
    """The English words of a text that is written in the language."""
    words = re.findall(r"[A-Za-z]+\d*", TINY.sub("", PATH.sub("", text)))
    return {word for word in words if word not in UNITS | NAMES | FOLDERS and not KEY.fullmatch(word)}


@pytest.mark.slow
def test_every_word_comes_from_the_catalogue_and_every_text_fits_and_meets_no_other(walk):
    """One test, so that no two processes take the same walk."""
    assert len(walk["seen"]) > 500
    assert not {text: place for text, place in walk["seen"].items() if english(text)}
    assert not walk["wrong"], "\n".join(map(str, walk["wrong"].items()))


def test_words_that_are_not_translated_are_found():
    assert english(f"Speed {pseudo.accented('of time')} 3.0 m/s") == {"Speed"}
    assert not english(pseudo.accented("The quick brown fox jumps over the lazy dog, 12 %"))


def test_the_language_is_a_third_longer_and_keeps_what_is_filled_in():
    made = pseudo.accented(texts.SCREENSHOT_SAVED)
    assert made.format(path="here").endswith(": here")
    longer = [len(pseudo.accented(text)) / len(text) for text in (texts.LOGBOOK_EMPTY, texts.NAMING, texts.BEGIN)]
    assert all(1.2 < each < 1.4 for each in longer)


@pytest.mark.parametrize(
    ("box", "how"),
    [
        ((1200, 100, 90, 12), "leaves the view"),
        ((95, 100, 90, 12), "leaves its panel"),
        ((20, 102, 60, 12), "meets Other"),
        ((600, 300, 80, 12), "is wider than its room of 60 points"),
    ],
)
def test_texts_that_do_not_fit_are_found(box: tuple[int, ...], how: str):
    page = Page(
        [
            Note("Text", pygame.FRect(box), 60.0 if box[0] == 600 else 200.0),
            Note("Other", pygame.FRect(10, 100, 40, 12)),
        ]
    )
    page.panels.append(pygame.FRect(90, 90, 60, 40))
    assert (("Text", how)) in set(misplaced(page))
    page.notes[0] = Note("Text", pygame.FRect(300, 300, 60, 12), 60.0)
    assert not list(misplaced(page))
