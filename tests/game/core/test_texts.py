"""Texts stand in one catalogue: what is used is there, what is there is used, and translations match the English."""

import ast
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from shutil import copytree
from typing import Any

import pytest
from babel.messages.catalog import Catalog
from babel.messages.mofile import read_mo

from docs import translations
from game.core import catalogue, texts
from game.core.catalogue import Plural

GAME = Path(texts.__file__).parents[1]
ROOT = GAME.parent
WORDS = re.compile(r"[A-Za-z]{2,} [a-zA-Z]{2,}")
COMMANDS = "game/cli.py"  # their help is English
NO_ENGLISH = {"tranquility flight", "wireless controller", "pro controller"}  # a file's format, devices' names


@pytest.fixture(scope="module")
def trees() -> dict[str, ast.Module]:
    """The modules that speak, by their path: those of the game and of its package's entry."""
    paths = sorted([*GAME.rglob("*.py"), *(ROOT / "tranquility").rglob("*.py")])
    return {path.relative_to(ROOT).as_posix(): ast.parse(path.read_text(encoding="utf-8")) for path in paths}


def spoken(tree: ast.AST) -> Iterator[ast.Constant]:
    """Yield the strings of a module that are neither documentation nor for its log, an error or an assertion."""
    silent: set[int] = set()
    for node in ast.walk(tree):
        logs = (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and ast.unparse(node.func.value) == "_log"
        )
        if isinstance(node, ast.Raise | ast.Assert) or logs:
            silent |= {id(child) for child in ast.walk(node)}
        elif isinstance(node, ast.Expr):
            silent.add(id(node.value))
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in silent:
            yield node


def test_no_sentence_stands_elsewhere(trees: dict[str, ast.Module]):
    found = {
        f"{path}: {node.value!r}"
        for path, tree in trees.items()
        for node in spoken(tree)
        if WORDS.search(node.value) and node.value not in NO_ENGLISH and path.startswith("game/") and path != COMMANDS
    }
    assert not found


# Names


def uses(tree: ast.AST) -> Iterator[tuple[str, ...]]:
    """Yield the texts that a module uses: a name, or a name and the key that it writes down."""

    def name(node: ast.AST) -> str:
        if not isinstance(node, ast.Attribute) or not node.attr.isupper():
            return ""
        return node.attr if isinstance(node.value, ast.Name) and node.value.id == "texts" else ""

    for node in ast.walk(tree):
        if text := name(node):
            yield (text,)
        if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant) and (text := name(node.value)):
            yield text, str(node.slice.value)


def unknown_and_unused(modules: Iterable[ast.Module], names: set[str]) -> tuple[set[str], set[str]]:
    """Return what is used and not in the catalogue, by its name or its key, and what is there and not used."""
    used = {use for tree in modules for use in uses(tree)} - {("LANGUAGE",)}
    roots = {name.partition(".")[0] for name in names}
    groups = {".".join(name.split(".")[:2]) for name in names}
    unknown = {".".join(use) for use in used if ".".join(use) not in (groups if len(use) > 1 else roots)}
    return unknown, roots - {use[0] for use in used}


def read_at_import(tree: ast.Module) -> list[str]:
    """Return the texts that are read when a module is imported, and would stay in the language of that moment."""
    waiting: list[ast.AST] = [tree]
    found = []
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            waiting += [*node.args.defaults, *filter(None, node.args.kw_defaults)]
            continue
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "texts":
            found.append(f"line {node.lineno}: {node.attr}")
        waiting += ast.iter_child_nodes(node)
    return found


def test_no_text_is_read_before_the_language_is_chosen(trees: dict[str, ast.Module]):
    assert not {path: found for path, tree in trees.items() if (found := read_at_import(tree))}


def english() -> Catalog:
    return translations.template(catalogue.DOMAIN)


def test_every_text_that_is_used_is_there_and_every_text_there_is_used(trees: dict[str, ast.Module]):
    names = {message.context for message in english() if message.id}
    unknown, unused = unknown_and_unused(trees.values(), names)
    assert not unknown
    assert unused == {"LANGUAGE_NAME"}  # of each language, by the catalogue itself


# Translations


@pytest.mark.parametrize("path", sorted(catalogue.LOCALE.glob("*/LC_MESSAGES/*.po")), ids=lambda path: path.parts[-3])
def test_a_language_matches_the_english(path: Path):
    """A change of the English need not wait for translators: what is missing or out of date is named, and English."""
    translated = translations.translations(path)
    assert not list(translations.faults(translated))
    if missing := translations.untranslated(translated, translations.template(path.stem)):
        pytest.xfail(f"{len(missing)} texts are in English: {', '.join(missing)}")


def test_faults_of_a_language_are_found():
    cases: list[tuple[dict[str, str | tuple[str, ...]], str]] = [
        ({"SCREENSHOT_SAVED": "Bild gespeichert: {pfad}"}, "braces"),
        ({"SCREENSHOT_SAVED": "Bild gespeichert"}, "braces"),
        ({"FLIGHTS_COUNT": ("eine Fähre",)}, "plural forms"),
        ({"FLIGHTS_COUNT": ("eine Fähre", "")}, "plural forms"),
        ({"SCREENSHOT_SAVED": "画像を保存: {path}"}, "Manrope has no '画'"),
        ({"FLIGHTS_COUNT": ("eine Fähre", "{count} Fähren"), "SCREENSHOT_SAVED": "Bild: {path}"}, ""),
    ]
    for translated, fault in cases:
        german = Catalog(locale="de")
        for message in english():
            if message.context in translated:
                german.add(message.id, translated[message.context], context=message.context)
        found = list(translations.faults(german))
        assert len(found) == bool(fault), translated
        assert all(fault in each for each in found), translated


def test_a_translation_follows_the_english():
    """By its name: one that was made from other English is kept, and named, and not shown; one that is gone goes."""
    german, now = Catalog(locale="de"), Catalog(locale="de")
    for name, said, translation in (("A", "Same", "Gleich"), ("B", "Before", "Vorher"), ("C", "Gone", "Weg")):
        german.add(said, translation, context=name)
    for name, said in (("A", "Same"), ("B", "After"), ("D", "New")):
        now.add(said, context=name)
    merged = translations.merged(german, now)
    assert [(each.context, each.string, each.fuzzy) for each in merged if each.id] == [
        ("A", "Gleich", False), ("B", "Vorher", True), ("D", None, False),
    ]  # fmt: skip
    assert merged.get("After", "B").previous_id == ["Before"]
    assert translations.untranslated(merged, now) == ["B", "D"]


def test_each_heading_stands_once():
    lines = (catalogue.LOCALE / f"{catalogue.DOMAIN}.pot").read_text(encoding="utf-8").splitlines()
    headings = [line for line in lines if line.startswith("# ")]
    assert len(headings) == len(set(headings)) > 1


@pytest.mark.parametrize("language", ["de", "es"])
def test_a_language_that_is_brought_up_to_date_keeps_its_head(language: str, tmp_path: Path):
    path = copytree(catalogue.LOCALE, tmp_path / "locale") / language / "LC_MESSAGES" / f"{catalogue.DOMAIN}.po"
    before = path.read_text(encoding="utf-8").partition("msgctxt")[0]
    translations.follow(language, tmp_path / "locale")
    assert path.read_text(encoding="utf-8").partition("msgctxt")[0] == before


def test_what_is_filled_in_has_a_name():
    """A translation may need another order."""
    for message in english():
        for text in (message.id,) if isinstance(message.id, str) else message.id:
            found = translations.braces(text)
            assert all(found) or len(found) == 1, f"{message.context}: {text}"


# What the game reads


def contents(texts: Catalog) -> dict[Any, Any]:
    found = {}
    for message in texts:
        context = message.context
        name = context.decode() if isinstance(context, bytes) else context  # Babel's reader leaves it as it is
        if message.id:
            found[name, hashable(message.id)] = hashable(message.string)
    return found


def hashable(words: str | list[str] | tuple[str, ...] | None) -> str | tuple[str, ...]:
    return words or "" if isinstance(words, str | None) else tuple(words)


def test_what_the_game_reads_is_what_babel_makes_of_what_people_write():
    folder = catalogue.LOCALE
    with (folder / "en" / "LC_MESSAGES" / "tranquility.mo").open("rb") as file:
        assert contents(read_mo(file)) == contents(translations.english())
    assert contents(translations.template("ai")) == contents(translations.of_ai())
    for path in folder.glob("*/LC_MESSAGES/*.po"):
        kept = {key: text for key, text in contents(translations.translations(path)).items() if any(text)}
        with path.with_suffix(".mo").open("rb") as file:
            read = contents(read_mo(file))
        assert {key: text for key, text in read.items() if text != key[1]}.items() <= kept.items()  # or English
    assert translations.STUB.read_text(encoding="utf-8") == translations.stub(catalogue.read(folder))


@pytest.fixture
def german(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., dict[str, object]]:
    """The texts in German, of which so much is translated."""

    def read(**translated: str | tuple[str, ...]) -> dict[str, object]:
        copytree(catalogue.LOCALE / "en", tmp_path / "en")
        made = Catalog(locale="de")
        for message in english():
            if message.context in translated:
                made.add(message.id, translated[message.context], context=message.context)
        (tmp_path / "de" / "LC_MESSAGES").mkdir(parents=True)
        translations.write_compiled(tmp_path / "de" / "LC_MESSAGES" / "tranquility.mo", made)
        monkeypatch.setenv("LANGUAGE", "de_AT:en")
        return catalogue.read(tmp_path)

    return read


def test_a_language_stands_in_for_english_as_far_as_it_goes(german, tmp_path: Path):
    read = german(PAUSE_TITLE="Angehalten", FLIGHTS_COUNT=("eine Fähre", "{count} Fähren"))
    assert read["PAUSE_TITLE"] == "Angehalten"
    assert read["PAUSE_RESUME"] == "Resume"
    landers = read["FLIGHTS_COUNT"]
    assert isinstance(landers, Plural)
    assert [landers.format(count=count) for count in (0, 1, 2)] == ["0 Fähren", "eine Fähre", "2 Fähren"]
    assert catalogue.language(tmp_path) == "de"


def test_without_a_language_that_is_there_texts_are_english(monkeypatch: pytest.MonkeyPatch):
    for name in ("C", "fr_FR.UTF-8", "en_GB"):
        monkeypatch.setenv("LANGUAGE", name)
        assert catalogue.language(catalogue.LOCALE) == "en"
        assert catalogue.read(catalogue.LOCALE)["PAUSE_RESUME"] == "Resume"


def test_the_player_chooses_the_language(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("LANGUAGE", "en")
    assert list(catalogue.languages(catalogue.LOCALE).values()) == ["Deutsch", "English", "Español"]
    for code, said in (("de", "Weiter"), ("es", "Seguir"), ("", "Resume")):
        assert texts.choose(code)
        assert not texts.choose(code)
        assert (code or "en", said) == (texts.LANGUAGE, texts.PAUSE_RESUME)


def test_english_stands_in_for_a_language_that_is_damaged(german, tmp_path: Path):
    german(PAUSE_TITLE="Angehalten")
    path = tmp_path / "de" / "LC_MESSAGES" / "tranquility.mo"
    whole = path.read_bytes()
    for length in (0, 3, 20, len(whole) // 2):
        folder = tmp_path / str(length)  # gettext keeps what it has read
        copytree(tmp_path / "en", folder / "en")
        (folder / "de" / "LC_MESSAGES").mkdir(parents=True)
        (folder / "de" / "LC_MESSAGES" / path.name).write_bytes(whole[:length])
        assert catalogue.read(folder)["PAUSE_TITLE"] == "Paused", f"cut to {length} bytes"
        assert catalogue.language(folder) == "en"


def test_a_damaged_english_catalogue_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("LANGUAGE", "en")
    copytree(catalogue.LOCALE / "en", tmp_path / "en")
    path = tmp_path / "en" / "LC_MESSAGES" / "tranquility.mo"
    whole = path.read_bytes()
    for length in (60_000, 20, 0):
        path.write_bytes(whole[:length])
        with pytest.raises(ValueError, match=r"tranquility\.mo"):
            catalogue.read(tmp_path)


def test_a_text_is_found_by_name_key_and_place():
    assert texts.MENU["play"] == ("Play", "Land by hand, and hand the stick to a network whenever you like.")
    assert texts.OUTCOMES["CRASHED"] == ("Crashed", "")  # as long as the others of its group
    assert texts.CHOICES_PADS_WORDS[1].startswith("three")
    assert [texts.RUN_SETTINGS.format(preset="Modern", count=count) for count in (1, 2)] == [
        "Trained by settings of its own: 1 is not as in Modern",
        "Trained by settings of its own: 2 are not as in Modern",
    ]
