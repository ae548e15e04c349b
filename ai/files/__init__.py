"""Files that anybody may have made: bounded reading, checked values, whole writing, one writer at a time.

The lowest floor of `ai` and `game`; it stands on NumPy, and for locks on filelock.
"""

from ai.files.folder import (
    CONFIG,
    NETWORK,
    OF_A_RUN,
    STATE_FILE,
    FolderKind,
    atomic_folder,
    claimed_folder,
    recover_all,
    recover_folder,
    take_folder,
    user_dir,
)
from ai.files.reading import (
    CONTROLS,
    MOST,
    array_like,
    brief,
    count_of,
    described,
    inside,
    number_of,
    parse_json,
    problem_in,
    read_array,
    read_arrays,
    read_bytes,
    read_json,
    read_text,
    shown,
)
from ai.files.schema import (
    Above,
    Count,
    Duration,
    OneOf,
    OtherVersionError,
    Seed,
    Share,
    Sized,
    Within,
    check_header,
    read_as,
    read_lines,
    sound_fields,
)
from ai.files.writing import append_line, free_path, take, write_bytes, write_text

__all__ = [
    "CONFIG", "CONTROLS", "MOST", "NETWORK", "OF_A_RUN", "STATE_FILE", "Above", "Count", "Duration", "FolderKind",
    "OneOf", "OtherVersionError", "Seed", "Share", "Sized", "Within", "append_line", "array_like", "atomic_folder",
    "brief", "check_header", "claimed_folder", "count_of", "described", "free_path", "inside", "number_of",
    "parse_json", "problem_in", "read_array", "read_arrays", "read_as", "read_bytes", "read_json", "read_lines",
    "read_text", "recover_all", "recover_folder", "shown", "sound_fields", "take", "take_folder", "user_dir",
    "write_bytes", "write_text",
]  # fmt: skip
