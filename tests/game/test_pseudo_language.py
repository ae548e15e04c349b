"""Every scene in a language that nobody speaks, and in German and Spanish: all is translated, and fits, in any size."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pygame
import pytest

from game.core import catalogue, texts
from tests.support import pseudo
from tests.support.written import Note, Page, misplaced

ROOT = Path(__file__).parents[2]
WINDOWS = "800x600", "720x1280"  # beside the usual one; larger ones of its shape are laid out alike
# What is the same in every language: units, and keys that are named by their letter or number.
UNITS = {"m", "s", "ms", "min", "k", "M"}
KEY = re.compile(r"[A-Z]|F\d+")
# Names of languages, of networks, of errors in Python, and of what the tests ask in their own dialogs.
NAMES = {"English", "modern", "classic", "anywhere", "mine", "ValueError", "a", "b", "yes", "no", "name"}
FOLDERS = {"ai", "engine", "examples"}  # of our own code, whose lines some screens show
PATH = re.compile(r"/\S*")
TINY = re.compile(r"\d+e[-−]\d+")  # a number: 5e-05


def walked(language: str, folder: Path, *windows: str) -> dict[str, dict[str, str]]:
    """Walk through all screens in a language; return what was seen, and what was misplaced, each with where."""
    done = subprocess.run(
        [sys.executable, "-m", "tests.support.pseudo_walk", str(folder), *windows],
        cwd=ROOT,
        env=os.environ | {"LANGUAGE": language, "LANG": "en_US.UTF-8", "OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=False,
        timeout=1800,  # it takes a minute, and many on a busy machine
    )
    assert done.returncode == 0, done.stderr
    walk: dict[str, dict[str, str]] = json.loads(done.stdout)
    return walk


def english(text: str) -> set[str]:
    """The English words of a text that is written in the language."""
    words = re.findall(r"[A-Za-z]+\d*", TINY.sub("", PATH.sub("", text)))
    return {word for word in words if word not in UNITS | NAMES | FOLDERS and not KEY.fullmatch(word)}


@pytest.mark.slow
def test_every_word_comes_from_the_catalogue_and_every_text_fits_and_meets_no_other(tmp_path: Path):
    """One test, so that no two processes take the same walk."""
    pseudo.make(tmp_path)
    walk = walked(pseudo.CODE, tmp_path)
    assert len(walk["seen"]) > 500
    assert not {text: place for text, place in walk["seen"].items() if english(text)}
    assert not walk["wrong"], "\n".join(map(str, walk["wrong"].items()))


@pytest.mark.slow
def test_no_text_of_a_language_is_misplaced_where_english_is_not(subtests: pytest.Subtests):
    """Where English has too little room as well, the screen is to be mended, and not the translation."""
    known = set(walked(catalogue.ENGLISH, catalogue.LOCALE, *WINDOWS)["wrong"].values())
    for language in sorted({*catalogue.languages(catalogue.LOCALE)} - {catalogue.ENGLISH}):
        with subtests.test(language=language):
            walk = walked(language, catalogue.LOCALE, *WINDOWS)
            assert len(walk["seen"]) > 500
            wrong = {text: place for text, place in walk["wrong"].items() if place not in known}
            assert not wrong, "\n".join(map(str, wrong.items()))


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
