"""What the game sounds like: nothing yet."""

from __future__ import annotations


class Sound:
    """Plays sounds by key. This one is silent, as is any machine without an audio device."""

    def play(self, key: str, volume: float = 1.0) -> None:
        """Play a short sound once."""

    def loop(self, key: str, volume: float) -> None:
        """Keep a sound going at that volume, 0 to 1; zero stops it."""

    def stop(self) -> None:
        """Stop every sound."""
