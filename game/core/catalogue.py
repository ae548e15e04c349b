"""Catalogues of texts: the English names and sentences, in the player's language as far as it has been translated.

A text has a name in the program, which is its context in the catalogue, and English words, which are its message. The
language is chosen by gettext's own rules, by the first of VARIABLES; English stands in for what is missing.
"""

from __future__ import annotations

import gettext
import os
import struct
from collections.abc import Callable, Iterator
from io import BytesIO
from operator import index
from pathlib import Path
from typing import Any, Final

DOMAIN: Final = "tranquility"
AI_DOMAIN: Final = "ai"  # what `ai` says in English, which knows nothing of players or of languages
ENGLISH: Final = "en"
VARIABLES: Final = ("LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG")  # of the environment
LOCALE = Path(__file__).parents[1] / "locale"  # a test reads another
_CONTEXT_ENDS: Final = "\x04"
_DAMAGE: Final = (OSError, ValueError, LookupError, ArithmeticError, struct.error)  # what reading a cut one raises


class Plural(str):
    """A text with a count. `format` takes the form that the language has for `count`; as a string, it is one of many.

    Python's own `str.format` fills in the rest.
    """

    __slots__ = ("_choose",)
    _choose: Callable[[int], str]

    @classmethod
    def of(cls, choose: Callable[[int], str]) -> Plural:
        """Make a text of what returns its form for a count."""
        text = cls(choose(2))
        text._choose = choose
        return text

    def format(self, *args: object, **values: Any) -> str:
        """Fill in `values`, of which `count` is a whole number and chooses the form."""
        return self._choose(index(values["count"])).format(*args, **values)


def capital(words: str) -> str:
    """Begin with a capital letter; the others stay as they are, for German nouns have theirs."""
    return words[:1].upper() + words[1:]


def read(folder: Path) -> dict[str, Any]:
    """Return all texts by name: a string, a `Plural`, or a group of texts, as a tuple or by key.

    A name's parts after its first are keys of groups. Keys from 0 on make a tuple; other numbers are whole numbers. In
    a group of tuples, all are as long as the longest: where the catalogue has nothing, a text is empty.

    Raises ValueError, which names the file, if the English catalogue cannot be read.
    """
    language = _translation(DOMAIN, folder)
    tree: dict[str, Any] = {}
    for name, one, many in _english(folder / ENGLISH / "LC_MESSAGES" / f"{DOMAIN}.mo"):
        *groups, last = name.split(".")
        group = tree
        for each in groups:
            group = group.setdefault(each, {})
        group[last] = _plural(language, name, one, many) if many else language.pgettext(name, one)
    return {name: _group(texts) if isinstance(texts, dict) else texts for name, texts in tree.items()}


def language(folder: Path) -> str:
    """Return the code of the language that texts are in, as far as they are translated."""
    readable = isinstance(_translation(DOMAIN, folder), gettext.GNUTranslations)
    return Path(gettext.find(DOMAIN, folder) or "").parts[-3] if readable else ENGLISH


def languages(folder: Path) -> dict[str, str]:
    """Return all languages that there are, by their codes: how each calls itself."""
    found = sorted(path.parts[-3] for path in folder.glob(f"*/LC_MESSAGES/{DOMAIN}.mo"))
    return {code: _named(folder, code) for code in found}


def _named(folder: Path, code: str) -> str:
    try:
        return gettext.translation(DOMAIN, folder, [code]).pgettext("LANGUAGE_NAME", "English")
    except _DAMAGE:
        return code


def system() -> str:
    """Return the system's languages as LANGUAGE has them; where no variable names one, as on Windows, SDL does."""
    if preferred := next(filter(None, map(os.environ.get, VARIABLES)), ""):
        return preferred
    from pygame.system import get_pref_locales

    return ":".join(each["language"] for each in get_pref_locales())


def said_in(folder: Path) -> Callable[[str], str]:
    """Return what turns a sentence of `ai` into the player's language; one that is not in its catalogue stays."""
    return _translation(AI_DOMAIN, folder).gettext


def _translation(domain: str, folder: Path) -> gettext.NullTranslations:
    """Return a catalogue of the player's language; without one that can be read, English stands in."""
    try:
        return gettext.translation(domain, folder, fallback=True)
    except _DAMAGE:
        return gettext.NullTranslations()


def _plural(language: gettext.NullTranslations, name: str, one: str, many: str) -> Plural:
    return Plural.of(lambda count: language.npgettext(name, one, many, count))


def _group(texts: dict[str, Any]) -> dict[str | int, Any] | tuple[Any, ...]:
    parts = {_key(key): _group(each) if isinstance(each, dict) else each for key, each in texts.items()}
    if parts.keys() == set(range(len(parts))):
        return tuple(parts[number] for number in range(len(parts)))
    if longest := max((len(each) for each in parts.values() if isinstance(each, tuple)), default=0):
        return {key: (*each, *("",) * (longest - len(each))) for key, each in parts.items()}
    return parts


def _key(part: str) -> str | int:
    return int(part) if part.removeprefix("-").isdecimal() else part


def _english(path: Path) -> Iterator[tuple[str, str, str]]:
    """Yield the name, the words, and the words for many or "", of every text in a compiled catalogue."""
    try:
        file = BytesIO(path.read_bytes())
        found: dict[Any, str] = gettext.GNUTranslations(file)._catalog  # type: ignore[attr-defined]
    except _DAMAGE as error:
        raise ValueError(f"{path} cannot be read") from error
    for key, words in found.items():  # of a text with a count, a key for each form: 0 for one, 1 for many
        message, form = key if isinstance(key, tuple) else (key, None)
        name, ends, _ = message.partition(_CONTEXT_ENDS)
        if ends and form in (None, 0):  # without a context, it is the catalogue's head
            yield name, words, "" if form is None else found[message, 1]
