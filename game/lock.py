"""The lock of a file, which the game shares with the commands: see `ai.nn.lock`."""

from ai.nn.lock import Lock, take, take_folder

__all__ = ["Lock", "take", "take_folder"]
