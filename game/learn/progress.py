"""Progress on the path: guesses given, pages read and chapters done, kept in the player's settings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from game.core import texts

if TYPE_CHECKING:
    from game.core.settings import Settings

PAGES: Final = ("predict", "try", "why", "code")
_MOST_ANSWERS: Final = 4


class Progress:
    """What the player has done on the path. Damaged values in the settings count as nothing done.

    The caller saves the settings after a change.
    """

    def __init__(self, settings: Settings) -> None:
        self._settings = settings

    def guess(self, key: str) -> int | None:
        """Return the number of the answer that was given in a chapter; None before."""
        value = self._value(key, "guess")
        return value if type(value) is int and 0 <= value < _MOST_ANSWERS else None

    def answer(self, key: str) -> str:
        """Return the words of the answer that was given; empty before."""
        guess = self.guess(key)
        return dict(enumerate(texts.LEARN_ANSWERS[key])).get(guess, "") if guess is not None else ""

    def page(self, key: str) -> int:
        """Return the page, an index of `PAGES`, on which a chapter was left; 0 before it was opened."""
        value = self._value(key, "page")
        return value if type(value) is int and 0 <= value < len(PAGES) else 0

    def done(self, key: str) -> bool:
        """Return whether a chapter was tried and its "see why" read."""
        return self._value(key, "done") is True

    def begun(self, key: str) -> bool:
        """Return whether a chapter was opened before."""
        return isinstance(self._settings.learnt.get(key), dict)

    def note(self, key: str, **values: int | bool) -> None:
        """Note a `guess`, a `page` or that a chapter is `done`."""
        before = self._settings.learnt.get(key)
        self._settings.learnt[key] = {**(before if isinstance(before, dict) else {}), **values}

    def _value(self, key: str, name: str) -> Any:
        chapter = self._settings.learnt.get(key)
        return chapter.get(name) if isinstance(chapter, dict) else None
