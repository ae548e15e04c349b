"""The pilots of a player: files in a folder, and how they were measured."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Final

from ai.files.reading import read_text
from ai.files.schema import Share, Sized, Within, read_lines
from ai.files.writing import append_line, free_path, write_text

TEMPLATE: Final = Path(__file__).parents[2] / "assets" / "pilots" / "pilot.py"
_SUFFIX: Final = ".py"
_LARGEST: Final = 1_000_000  # last bytes of the measurements that are read
_LONGEST: Final = 255

_Figure = Annotated[float, Within(0, 1e9)]


@dataclass(frozen=True)
class Measured:
    """What came of a pilot's flights from the same starts.

    Attributes:
        seconds, fuel: those of the landings.
        when: when it began, in seconds since 1970.

    """

    name: Annotated[str, Sized(_LONGEST)]
    landed: Share
    seconds: _Figure = 0.0
    fuel: _Figure = 0.0
    when: Annotated[float, Within(0, 32_503_680_000 - 1)] = 0.0

    def stale(self, path: Path) -> bool:
        """Whether the file was saved again since."""
        try:
            return path.stat().st_mtime > self.when
        except OSError:  # it is gone
            return False


class PilotFolder:
    """The player's pilots. Nothing in them runs before it is asked for by name."""

    def __init__(self, user_dir: Path) -> None:
        self.folder = user_dir / "pilots"
        self.results = self.folder / "measured.jsonl"

    def files(self) -> dict[str, Path]:
        """Return the files by name; raises OSError for a folder that cannot be read."""
        try:
            found = sorted(self.folder.iterdir(), key=lambda path: path.stem)
        except FileNotFoundError:
            return {}
        return {path.stem: path for path in found if path.suffix == _SUFFIX and path.is_file()}

    def new(self) -> Path:
        """Write the template under a name that is free; return its path. Raises OSError."""
        path = free_path(self.folder, TEMPLATE.stem, _SUFFIX)
        write_text(path, read_text(TEMPLATE))
        return path

    def keep(self, measured: Measured) -> None:
        """Write down how a pilot was measured; raises OSError."""
        append_line(self.results, asdict(measured))

    def measured(self) -> list[Measured]:
        """Return all measurements, the latest last; raises OSError. Lines that make no sense are passed over."""
        try:
            return read_lines(Measured, self.results, _LARGEST)[0]
        except FileNotFoundError:
            return []
