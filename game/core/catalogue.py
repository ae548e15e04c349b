"""Catalogues of texts: the English names and sentences, in the player's language as far as it has been translated.

A text has a name in the program, which is its context in the catalogue, and English words, which are its message. The
language is chosen by gettext's own rules: LANGUAGE, LC_ALL, LC_MESSAGES, LANG; English stands in for what is missing.
"""

from __future__ import annotations

import gettext
import struct
from collections.abc import Callable, Iterator
from operator import index
from pathlib import Path
from typing import Any, Final

DOMAIN: Final = "tranquility"
AI_DOMAIN: Final = "ai"  # what `ai` says in English, which knows nothing of players or of languages
ENGLISH: Final = "en"
LOCALE = Path(__file__).parents[1] / "locale"  # a test reads another
_CONTEXT_ENDS, _FORM_ENDS = "\x04", "\0"


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


def read(folder: Path) -> dict[str, Any]:
    """Return all texts by name: a string, a `Plural`, or a group of texts, as a tuple or by key.

    A name's parts after its first are keys of groups. Keys from 0 on make a tuple; other numbers are whole numbers. In
    a group of tuples, all are as long as the longest: where the catalogue has nothing, a text is empty.
    """
    language = gettext.translation(DOMAIN, folder, fallback=True)
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
    path = gettext.find(DOMAIN, folder)
    return Path(path).parts[-3] if path else ENGLISH


def said_in(folder: Path) -> Callable[[str], str]:
    """Return what turns a sentence of `ai` into the player's language; one that is not in its catalogue stays."""
    return gettext.translation(AI_DOMAIN, folder, fallback=True).gettext


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
    """Yield the name, the words, and the words for many or "", of every text in a compiled catalogue.

    The format is described in the manual of GNU gettext, 10.3. The standard library answers for one message at a time.
    """
    data = path.read_bytes()
    count, table = struct.unpack_from("<2I", data, 8)
    places = struct.unpack_from(f"<{2 * count}I", data, table)
    for length, start in zip(places[::2], places[1::2], strict=True):
        name, ends, words = data[start : start + length].decode().partition(_CONTEXT_ENDS)
        if ends:  # without a context, it is the catalogue's head
            one, _, many = words.partition(_FORM_ENDS)
            yield name, one, many
