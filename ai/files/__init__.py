"""Files that anybody may have made: bounded reading, checked values, whole writing, one writer at a time.

The lowest floor of `ai`; it stands on NumPy alone.
"""

from ai.files.folder import (
    CONFIG,
    NETWORK,
    NEW,
    STALE,
    FolderKind,
    aside_for,
    atomic_folder,
    check_folder,
    claimed_folder,
    free_folder,
    moved_aside,
    recover_folder,
)
from ai.files.lock import Lock, lock_of, take, take_folder
from ai.files.reading import (
    CONTROLS,
    MOST,
    beside,
    brief,
    count_of,
    described,
    inside,
    number_of,
    open_file,
    parse_json,
    problem_in,
    read_array,
    read_arrays,
    read_bytes,
    read_end,
    read_json,
    read_standard_input,
    read_text,
    shown,
    synchronise,
    write_bytes,
    write_text,
)
from ai.files.schema import (
    Above,
    Count,
    Duration,
    OneOf,
    SchemaError,
    Seed,
    Share,
    Sized,
    Within,
    check_header,
    read_as,
    sound_fields,
)

__all__ = [
    "CONFIG", "CONTROLS", "MOST", "NETWORK", "NEW", "STALE", "Above", "Count", "Duration", "FolderKind", "Lock",
    "OneOf", "SchemaError", "Seed", "Share", "Sized", "Within", "aside_for", "atomic_folder", "beside", "brief",
    "check_folder", "check_header", "claimed_folder", "count_of", "described", "free_folder", "inside", "lock_of",
    "moved_aside", "number_of", "open_file", "parse_json", "problem_in", "read_array", "read_arrays", "read_as",
    "read_bytes", "read_end", "read_json", "read_standard_input", "read_text", "recover_folder", "shown",
    "sound_fields", "synchronise", "take", "take_folder", "write_bytes", "write_text",
]  # fmt: skip
