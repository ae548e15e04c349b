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

# Keys' names and hints
ARROWS: Final = "↑ ↓"
DPAD: Final = "D-pad"
HINT_MOVE: Final = "move"
HINT_CHOOSE: Final = "choose"
HINT_CHANGE: Final = "change"
HINT_BACK: Final = "back"
HINT_RESUME: Final = "resume"
HINT_FULL_SCREEN: Final = "full screen"
BACK: Final = "Back"
KEY_NAMES: Final = {
    "up": "↑",
    "down": "↓",
    "left": "←",
    "right": "→",
    "escape": "Esc",
    "return": "Enter",
    "space": "Space",
    "tab": "Tab",
}

# The menu: word, and the line beside it while it is in focus
MENU_LINE: Final = "A moon lander, and a neural network that learns to fly it."
MENU: Final = {
    "play": ("Play", "Fly it yourself, and hand over whenever you like."),
    "watch": ("Watch", "See the network land, and what it thinks on the way down."),
    "settings": ("Settings", "Screen, motion, colours, keys."),
    "quit": ("Quit", "Back to Earth."),
}

# Settings: label, and the line under it
SETTINGS_TITLE: Final = "Settings"
SETTINGS: Final = {
    "full_screen": ("Full screen", "F11 or Alt + Enter at any time."),
    "reduced_motion": ("Reduced motion", "No shaking, no easing, a still sky."),
    "colour_safe": ("Colours for every eye", "Good and beyond limits, told apart without red and green."),
    "show_hints": ("Hints", "The keys, and a word of advice, while you fly."),
}
SWATCH_GOOD: Final = "within limits"
SWATCH_WARN: Final = "beyond limits"
KEYS_TITLE: Final = "CONTROLS"
KEYS_KEYBOARD: Final = "KEYBOARD"
KEYS_PAD: Final = "GAMEPAD"
# What it does, and the pad's words where no single button says it.
KEYS: Final = (
    ("Main engine", "A, right trigger"),
    ("Steer left", "Left stick, D-pad"),
    ("Steer right", "Left stick, D-pad"),
    ("Hand over", ""),
    ("Retry", ""),
    ("Pause", ""),
    ("Full screen", "–"),
    ("Take a picture", "–"),
)

# Pause
PAUSE_TITLE: Final = "Paused"
PAUSE_RESUME: Final = "Resume"
PAUSE_RETRY: Final = "Retry"
PAUSE_SETTINGS: Final = "Settings"
PAUSE_LEAVE: Final = "Leave"
