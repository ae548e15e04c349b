"""Rows of a run's settings: few knobs first, a page of them on demand, and presets."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from operator import attrgetter

from game.core import texts
from game.core.scene import push
from game.drawing.tokens import HUMAN, MUTE, NET, SMALL, TITLE
from game.training.run_kind import RunKind
from game.training.run_settings import RunSettings, figure, help_of, label
from game.ui.panel import Column


def describe_few(column: Column, kind: RunKind, settings: RunSettings, names: Sequence[str]) -> None:
    """Add a few knobs; one that has taken another's place says why."""
    for name in names:
        _describe_knob(column, kind, settings, name)
        column.explain(_help(kind, settings, name))
        if name not in kind.first:
            column.aside(texts.KNOBS_LAST)


def describe_page(column: Column, kind: RunKind, settings: RunSettings, close: Callable[[], None]) -> None:
    """Add the presets, and every knob with what it does, and the chapter that explains it."""
    words = kind.words()
    column.text(words[settings.preset][0], size=TITLE)
    if settings.changed:
        column.aside(texts.KNOBS_CHANGED)
    column.aside(words[settings.preset][1])
    others = [preset for preset in kind.presets if settings.changed or preset != settings.preset]
    column.words([(texts.BACK, close), *((words[preset][0], partial(settings.load, preset)) for preset in others)])
    for name, (_, chapter) in kind.knobs.items():
        column.gap(6)
        _describe_knob(column, kind, settings, name)
        column.aside(_help(kind, settings, name))
        if chapter:
            title = texts.KNOBS_CHAPTER.format(chapter=texts.LEARN[chapter]["title"])
            column.button(title, partial(push, "chapter", chapter), size=SMALL).pad = 1.0


def _help(kind: RunKind, settings: RunSettings, name: str) -> str:
    said = help_of(kind.of, name)
    return said if settings.is_live(name) else f"{said} {texts.KNOBS_NEW_RUN}"


def _describe_knob(column: Column, kind: RunKind, settings: RunSettings, name: str) -> None:
    """Add a choice of words, or a track with the preset's value among its stops: blue if it acts at once."""
    value, home = settings.read(name), attrgetter(name)(kind.presets[settings.preset])
    stops = dict.fromkeys((*kind.knobs[name].stops, home, value))
    if isinstance(value, bool | str | tuple):
        choices = list(stops)
        words, index = list(map(figure, choices)), choices.index(value)
        column.choice(label(name), words, index, lambda number: settings.turn(name, choices[number]), SMALL)
        return
    places = sorted(stops, key=abs)
    slider = column.slider(
        label(name), places.index(value), (0, len(places) - 1),
        lambda place: settings.turn(name, places[round(place)]), step=1,
        figure=lambda place: figure(places[round(place)]),
    )  # fmt: skip
    waits = value != attrgetter(name)(settings.in_force)
    slider.colour = NET if settings.is_live(name) else HUMAN if waits else MUTE
