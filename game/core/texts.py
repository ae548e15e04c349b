"""Every text of the game by its name, in the player's language, from the catalogues in `game/locale`.

`texts.pyi` has the names and shapes, for type checkers and for readers; it is made from the English catalogue. Texts
change with the language, so they are read where they are shown, and never while a module is imported.
"""

import os

from game.core import catalogue

_system = ""  # the system's languages, as gettext's variable LANGUAGE has them; empty until `choose` has looked


def choose(language: str = "") -> bool:
    """Speak a language from now on, by its code, or else the system's; return whether it is another than before.

    Commands without a window, and the game until then, go by the environment.
    """
    global _system  # noqa: PLW0603
    _system = _system or catalogue.system()
    before = catalogue.language(catalogue.LOCALE)
    os.environ["LANGUAGE"] = language or _system  # worker processes inherit it
    if catalogue.language(catalogue.LOCALE) == before:
        return False
    _read()
    return True


def _read() -> None:
    globals().update(
        catalogue.read(catalogue.LOCALE),
        said=catalogue.said_in(catalogue.LOCALE),
        LANGUAGE=catalogue.language(catalogue.LOCALE),
    )


try:
    _read()
except ValueError as error:  # nothing can be said without it
    raise SystemExit(f"tranquility: {error}; install the game again") from error
