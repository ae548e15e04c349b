"""Make what the game reads from the texts that people write; needs Babel, of the extra `test`.

python docs/translations.py       after a change to a text or a translation: update and compile all
python docs/translations.py de    begin German: game/locale/de/LC_MESSAGES/tranquility.po, and ai.po
"""

from __future__ import annotations

import sys
from dataclasses import fields
from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po, write_po

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from ai.digits.config import DigitConfig
from ai.lander.rules import ACTION_NAMES
from ai.training.config import Config
from game.core import catalogue

DOMAINS = (catalogue.DOMAIN, catalogue.AI_DOMAIN)
STUB = ROOT / "game" / "core" / "texts.pyi"
_HEAD = '''"""Names and shapes of all texts, made by docs/translations.py from tranquility.pot: do not edit."""

from typing import Final

from game.core.catalogue import Plural

LANGUAGE: Final[str]
damaged: Final[str]  # the path of a catalogue that cannot be read

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
    return read_po(lines, locale=language, abort_invalid=True)


def english(folder: Path = catalogue.LOCALE) -> Catalog:
    """Return the texts of the game, each as its own translation."""
    texts = template(catalogue.DOMAIN, folder)
    for message in texts:
        if message.id:
            message.string = message.id
    return texts


def of_ai() -> Catalog:
    """Return what `ai` says in English and a player reads: the names of actions, and what knobs are for."""
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


def begin(language: str, folder: Path = catalogue.LOCALE) -> None:
    """Write the catalogues of a language that has none yet: nothing in them is translated."""
    for domain in DOMAINS:
        path = folder / language / "LC_MESSAGES" / f"{domain}.po"
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists():
            _write_po(path, template(domain, folder, language))


def compile_all(folder: Path = catalogue.LOCALE) -> None:
    """Write the template of `ai`, every language's compiled catalogues, and the stub."""
    with (folder / f"{catalogue.AI_DOMAIN}.pot").open("wb") as file:
        file.write(_AI_HEAD.encode())
        write_po(file, of_ai(), width=120, omit_header=True)
    path = folder / catalogue.ENGLISH / "LC_MESSAGES" / f"{catalogue.DOMAIN}.mo"
    path.parent.mkdir(parents=True, exist_ok=True)
    write_compiled(path, english(folder))
    for source in sorted(folder.glob("*/LC_MESSAGES/*.po")):
        translated = read_po(source.read_bytes().splitlines(keepends=True), locale=source.parts[-3])
        translated.update(template(source.stem, folder))
        _write_po(source, translated)
        write_compiled(source.with_suffix(".mo"), translated)
    STUB.write_text(stub(catalogue.read(folder)), encoding="utf-8")


def write_compiled(path: Path, texts: Catalog) -> None:
    """Write a catalogue as the standard library reads it."""
    with path.open("wb") as file:
        write_mo(file, texts)


def _write_po(path: Path, texts: Catalog) -> None:
    with path.open("wb") as file:
        write_po(file, texts, width=120)


if __name__ == "__main__":
    for language in sys.argv[1:]:
        begin(language)
    compile_all()
