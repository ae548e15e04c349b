"""A language made of the English one, and what a walk through every scene in it shows.

No letter of it is an English one, and every text is a third longer; so what can be read has not been translated, and
what meets or leaves its place would do so in many languages.
"""

import re
import string
from pathlib import Path
from shutil import copytree

from babel.messages.catalog import Catalog
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po

from game.core import catalogue

CODE = "xx"
# Letters of which Manrope has pictures, as wide as those they stand for.
_LETTERS = dict(
    zip(
        string.ascii_letters,
        "áъčđéгĝħíĵķĺмňóрøřšťúνŵхýžÁБČĐÉГĜĦÍĴĶĹМŇÓРØŘŠŤÚΛŴХÝŽ",
        strict=True,
    )
)
_FIELD = re.compile(r"(\{[^}]*\})")


def accented(text: str) -> str:
    """Return a text with other letters, every third of them twice: what is filled in stays."""
    made, letters = "", 0
    for part in _FIELD.split(text):
        for letter in part:
            if part.startswith("{") or letter not in _LETTERS:
                made += letter
                continue
            letters += 1
            made += _LETTERS[letter] * (2 if letters % 3 == 2 else 1)
    return made


def make(folder: Path) -> None:
    """Write the catalogues of the language, beside English."""
    copytree(catalogue.LOCALE / catalogue.ENGLISH, folder / catalogue.ENGLISH)
    (folder / CODE / "LC_MESSAGES").mkdir(parents=True)
    for domain in (catalogue.DOMAIN, catalogue.AI_DOMAIN):
        made = Catalog(locale=catalogue.ENGLISH)
        with (catalogue.LOCALE / f"{domain}.pot").open("rb") as file:
            for message in read_po(file):
                if message.id:
                    forms = (message.id,) if isinstance(message.id, str) else message.id
                    strings = tuple(map(accented, forms))
                    made.add(message.id, strings if len(strings) > 1 else strings[0], context=message.context)
        with (folder / CODE / "LC_MESSAGES" / f"{domain}.mo").open("wb") as file:
            write_mo(file, made)
