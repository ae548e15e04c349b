"""Writes the settings in a thread of its own: to wait for a disk takes frames."""

from __future__ import annotations

import copy
import logging
import os
from queue import SimpleQueue
from threading import Event, Thread

from game.core import texts
from game.core.settings import Settings, SettingsFile, changes

_log = logging.getLogger("tranquility")


class SettingsWriter:
    """Keeps a file as the settings are. Each change is on its way to the disk at once, and there after `close`.

    Only what was changed here is written, so that two games on one folder leave each other's choices alone.

    Args:
        file: to write.
        settings: as they were read from it.

    """

    def __init__(self, file: SettingsFile, settings: Settings) -> None:
        self._file = file
        self._since = settings.to_dict()  # as they were written last
        self._unread = settings.unread  # until what could not be read is put aside
        self._problems: SimpleQueue[str] = SimpleQueue()
        self._wanted: SimpleQueue[Settings | Event | None] = SimpleQueue()
        self._thread: Thread | None = None

    def save(self, settings: Settings) -> None:
        """Have the settings written as they are now. Never waits."""
        self._tell(copy.deepcopy(settings))

    def problem(self) -> str:
        """Return why the last writing failed, once; empty if it did not."""
        found = ""
        while not self._problems.empty():
            found = self._problems.get_nowait()
        return found

    def wait(self) -> None:
        """Wait until all that was changed is on the disk, or has failed to get there."""
        if self._thread:
            done = Event()
            self._tell(done)
            done.wait()

    def close(self, settings: Settings) -> None:
        """Write the settings for the last time, and wait until that is done and the thread has ended."""
        self.save(settings)
        self._tell(None)
        if self._thread:
            self._thread.join()
            self._thread = None

    def _tell(self, wanted: Settings | Event | None) -> None:
        if self._thread is None:
            self._thread = Thread(target=self._work, name="settings", daemon=True)
            self._thread.start()
        self._wanted.put(wanted)

    def _work(self) -> None:
        while (wanted := self._wanted.get()) is not None:
            if isinstance(wanted, Event):
                wanted.set()
                continue
            try:
                self._write(wanted)
            except Exception as error:  # whoever waits must not wait for ever
                _log.exception("writing the settings")
                self._problems.put(texts.SETTINGS_NOT_SAVED.format(reason=error))

    def _write(self, settings: Settings) -> None:
        values = settings.to_dict()
        if not changes(values, self._since) and not self._unread and os.path.exists(self._file.path):  # noqa: PTH110
            return
        settings.unread = self._unread
        saved = self._file.save(settings, self._since)
        self._unread = settings.unread
        if saved:
            self._since = values
        else:
            self._problems.put(self._file.problem)
