from game.audio.instruments import INSTRUMENTS
from game.audio.mixer import Sound


class Listener(Sound):
    """Hears what would be played, without a device.

    Attributes:
        played: keys of short sounds in the order in which they were asked for.
        loops: volumes asked for since the last update.

    """

    def __init__(self) -> None:
        super().__init__()
        self.played: list[str] = []
        self.volumes: list[float] = []
        self.loops: dict[str, float] = {}

    def play(self, key: str, volume: float = 1.0) -> None:
        assert not INSTRUMENTS[key].loops
        self.played.append(key)
        self.volumes.append(volume)

    def loop(self, key: str, volume: float) -> None:
        assert INSTRUMENTS[key].loops
        self.loops[key] = volume

    def update(self) -> None:
        self.loops.clear()

    def heard(self) -> list[str]:
        """What was played since the last time."""
        played, self.played = self.played, []
        return played
