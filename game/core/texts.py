"""Every text of the game by its name, in the player's language, from the catalogues in `game/locale`.

`texts.pyi` has the names and shapes, for type checkers and for readers; it is made from the English catalogue.
"""

from game.core import catalogue

try:
    globals().update(catalogue.read(catalogue.LOCALE))
except ValueError as error:  # nothing can be said without it
    raise SystemExit(f"tranquility: {error}; install the game again") from error
said = catalogue.said_in(catalogue.LOCALE)
LANGUAGE = catalogue.language(catalogue.LOCALE)
damaged = catalogue.damaged(catalogue.LOCALE)
