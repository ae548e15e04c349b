"""Every English text of the game, by scene, ready for translation."""

from typing import Final

GAME: Final = "Tranquility"

# The window
SCREENSHOT_SAVED: Final = "Picture saved: {path}"
SCREENSHOT_FAILED: Final = "The picture could not be saved: {reason}"
NO_DISPLAY: Final = (
    "Tranquility needs a screen, and found none ({reason}).\n"
    "Start it from a desktop session. Training needs no screen: see `tranquility train --help`."
)

# After a fault
FAULT_TITLE: Final = "That screen has failed"
FAULT_KEPT: Final = "The game goes on, and your settings are safe."
FAULT_LOG: Final = "What happened is written down in {path}"
FAULT_BACK: Final = "{key}  back to the menu"
