"""Tests run in another order each time, and say in which.

Property tests draw the same examples every time: a suite that passed passes again. One thread each is enough.
"""

import gc
import os
import signal

import pytest

from main import limit_threads

limit_threads()
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell has what runs in its background ignore it

from hypothesis import settings  # noqa: E402

settings.register_profile("same", derandomize=True)
settings.load_profile("same")

# Files of tests need to outlive no power cut, and most of the time of writing one is the wait for the disk. Processes
# that tests start still wait; a test that asks when a file is flushed puts its own function here.
os.fsync = lambda fd: None


def pytest_collection_finish() -> None:
    """Keep modules and tests out of every later collection, as the game does: each game that closes collects once."""
    gc.collect()
    gc.freeze()


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Say how to run them in this order again; `-q` hides what pytest-randomly says of it."""
    seed = config.getoption("randomly_seed", None)
    if seed is not None:
        terminalreporter.write_line(f"the same order again: --randomly-seed={seed}")
