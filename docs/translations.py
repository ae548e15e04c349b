"""Make what the game reads from the texts that people write; needs Babel, of the extra `test`.

python -m docs.translations       after any change: compile all, and say what is missing or out of date
python -m docs.translations de    begin German, or bring it up to date with the English, in game/locale/de
"""

from __future__ import annotations

import os
import re
import string
import sys
from collections.abc import Iterator, Sequence
from dataclasses import fields
from datetime import UTC, datetime
from functools import cache
from io import BytesIO
from pathlib import Path

from babel.messages.catalog import Catalog, Message
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po, write_po
from font_manrope import font_files

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")

from pygame import freetype

from ai.digits.config import DigitConfig
from ai.lander.rules import ACTION_NAMES
from ai.training.config import Config
from game.core import catalogue

DOMAINS = (catalogue.DOMAIN, catalogue.AI_DOMAIN)
CONTROL = "\n"
_HEADERS = {"Language", "Plural-Forms", "MIME-Version", "Content-Type"}  # that the game reads
STUB = ROOT / "game" / "core" / "texts.pyi"
_HEAD = '''"""Names and shapes of all texts, made by docs/translations.py from tranquility.pot: do not edit."""

from typing import Final

from game.core.catalogue import Plural

LANGUAGE: Final[str]

def said(sentence: str, /) -> str: ...
def choose(language: str = "") -> bool: ...

'''


_AI_HEAD = """# What the player reads of `ai`, in English, made by docs/translations.py from its sources: do not edit.
msgid ""
msgstr ""
"Content-Type: text/plain; charset=utf-8\\n"

"""


def template(domain: str, folder: Path = catalogue.LOCALE, language: str = catalogue.ENGLISH) -> Catalog:
    """Read an English template: the texts, each with an empty translation, in a language's plural forms."""
    lines = (folder / f"{domain}.pot").read_bytes().splitlines(keepends=True)
    return _dated(read_po(lines, locale=language, abort_invalid=True))


def _dated(texts: Catalog) -> Catalog:
    """Give a catalogue a date that stays, so that the same texts are the same bytes."""
    texts.creation_date = texts.revision_date = datetime(2026, 1, 1, tzinfo=UTC)
    return texts


def english(folder: Path = catalogue.LOCALE) -> Catalog:
    """Return the texts of the game, each as its own translation."""
    texts = template(catalogue.DOMAIN, folder)
    for message in texts:
        if message.id:
            message.string = message.id
    return texts


def of_ai() -> Catalog:
    """Return what `ai` says in English and a player reads: names of actions, and what knobs are for."""
    found = Catalog(locale=catalogue.ENGLISH)
    for name in ACTION_NAMES:
        found.add(name, auto_comments=["An action: which engines fire."])
    for config in (Config, DigitConfig):
        for field in fields(config):
            found.add(field.metadata["help"], auto_comments=[f"The knob {field.name}."])
    return found


def stub(texts: dict[str, object]) -> str:
    """Return the source of the stub: a type for each text and group of texts."""
    return _HEAD + "".join(f"{name}: Final[{_type(texts[name])}]\n" for name in sorted(texts))


def _type(text: object) -> str:
    if isinstance(text, tuple):
        return f"tuple[{', '.join(map(_type, text))}]"
    if isinstance(text, dict):
        keys = {type(key).__name__ for key in text}
        return f"dict[{' | '.join(sorted(keys))}, {' | '.join(sorted({_type(each) for each in text.values()}))}]"
    return "Plural" if isinstance(text, catalogue.Plural) else "str"


def translations(path: Path) -> Catalog:
    """Read a language's catalogue, of which the folder says the language."""
    return _dated(read_po(path.read_bytes().splitlines(keepends=True), locale=path.parts[-3]))


def merged(translated: Catalog, english_texts: Catalog) -> Catalog:
    """Return all texts with their translations; one that was made from other English is fuzzy, and keeps that."""
    before = {_name(message): message for message in translated if message.id}
    for message in english_texts:
        known = translated.get(message.id, message.context) or before.get(_name(message))
        if message.id and known and any(_forms(known.string)):
            message.flags |= known.flags & {"fuzzy"}
            message.previous_id = known.previous_id
            if known.id != message.id:
                message.flags.add("fuzzy")
                message.previous_id = _forms(known.id)
            if isinstance(known.id, str) == isinstance(message.id, str):
                message.string = known.string
    return english_texts


def untranslated(translated: Catalog, english_texts: Catalog) -> list[str]:
    """Return the names of the texts that are missing in a language, or were made from other English."""
    return [
        _name(message)
        for message in english_texts
        if message.id
        and not (
            (known := translated.get(message.id, message.context)) and any(_forms(known.string)) and not known.fuzzy
        )
    ]


def faults(translated: Catalog) -> Iterator[str]:
    """Yield what is wrong with translations: other braces than the English, missing forms, letters without pictures."""
    for message in translated:
        strings, forms = _forms(message.string), _forms(message.id)
        if not message.id or not any(strings) or message.fuzzy:
            continue
        if len(forms) > 1 and (len(strings) != translated.num_plurals or not all(strings)):
            yield f"{_name(message)}: plural forms are missing"
        # The form for one may say the number in a word.
        wanted, may_miss = set.union(*map(braces, forms)), {"count"} if len(forms) > 1 else set()
        if any(not wanted - may_miss <= braces(form) <= wanted for form in strings if form):
            yield f"{_name(message)}: {strings} has other braces than {forms}"
        if missing := [letter for form in strings for letter in form if letter not in CONTROL and not drawn(letter)]:
            yield f"{_name(message)}: Manrope has no {', '.join(map(repr, missing))}"


@cache
def drawn(letter: str) -> bool:
    """Whether the game's type has a picture of a letter."""
    freetype.init()
    return freetype.Font(font_files["Manrope"], 16).get_metrics(letter)[0] is not None


def braces(text: str) -> set[str]:
    """Return the names in a text's braces."""
    return {field for _, field, _, _ in string.Formatter().parse(text) if field is not None}


def _forms(text: str | Sequence[str] | None) -> list[str]:
    return [text or ""] if isinstance(text, str | None) else list(text)


def _name(message: Message) -> str:
    return message.context or str(message.id)


def follow(language: str, folder: Path = catalogue.LOCALE) -> None:
    """Write the catalogues of a language with all texts of today, as far as they are translated."""
    for domain in DOMAINS:
        path = folder / language / "LC_MESSAGES" / f"{domain}.po"
        path.parent.mkdir(parents=True, exist_ok=True)
        texts = template(domain, folder, language)
        if path.exists():
            before = translations(path)
            texts.mime_headers = [("Plural-Forms", before.plural_forms)]  # Babel's may be others by now
            texts = merged(before, texts)
        written = BytesIO()
        write_po(written, texts, width=120, include_previous=True)
        path.write_bytes(re.sub(rb'"Generated-By:.*\n', b"", written.getvalue()))


def compile_all(folder: Path = catalogue.LOCALE) -> None:
    """Write the template of `ai`, every language's compiled catalogues, and the stub."""
    with (folder / f"{catalogue.AI_DOMAIN}.pot").open("wb") as file:
        file.write(_AI_HEAD.encode())
        write_po(file, of_ai(), width=120, omit_header=True)
    path = folder / catalogue.ENGLISH / "LC_MESSAGES" / f"{catalogue.DOMAIN}.mo"
    path.parent.mkdir(parents=True, exist_ok=True)
    write_compiled(path, english(folder))
    for source in sorted(folder.glob("*/LC_MESSAGES/*.po")):
        write_compiled(source.with_suffix(".mo"), translations(source))
    STUB.write_text(stub(catalogue.read(folder)), encoding="utf-8")


def check(folder: Path = catalogue.LOCALE) -> Iterator[str]:
    """Yield what there is to do for each language."""
    for source in sorted(folder.glob("*/LC_MESSAGES/*.po")):
        translated, texts = translations(source), template(source.stem, folder)
        missing = untranslated(translated, texts)
        for each in (*faults(translated), *([f"in English as yet: {', '.join(missing)}"] if missing else [])):
            yield f"{source.parts[-3]}: {each}"


class _Compiled(list[Message]):
    """The texts of a catalogue in order, the head first: all that `write_mo` wants of one."""

    charset = "utf-8"


def write_compiled(path: Path, texts: Catalog) -> None:
    """Write a catalogue as the standard library reads it; of the head only that, so that any Babel writes the same."""
    head = "\n".join(f"{name}: {value}" for name, value in texts.mime_headers if name in _HEADERS)
    with path.open("wb") as file:
        write_mo(file, _Compiled([Message("", head), *list(texts)[1:]]))  # type: ignore[arg-type]


if __name__ == "__main__":
    for language in sys.argv[1:]:
        follow(language)
    compile_all()
    print("\n".join(check()))
