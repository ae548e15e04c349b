"""Background writer of the settings: a thread of its own, because waiting for the disk would drop frames."""

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
    """Thread that writes each change of the settings to their file at once; after `close` all changes are on disk.

    Only the values changed here are written, so that two games on one folder do not overwrite each other's choices.

    Args:
        file: the file to write.
        settings: the settings as read from that file.

    """

    def __init__(self, file: SettingsFile, settings: Settings) -> None:
        self._file = file
        self._since = settings.to_dict()  # the values last written
        self._unread = settings.unread  # True until an unreadable file has been put aside
        self._problems: SimpleQueue[str] = SimpleQueue()
        self._wanted: SimpleQueue[Settings | Event | None] = SimpleQueue()
        self._thread: Thread | None = None

    def save(self, settings: Settings) -> None:
        """Queue the present settings for writing. Never waits."""
        self._tell(copy.deepcopy(settings))

    def problem(self) -> str:
        """Return why the last write failed, once only; empty if it succeeded."""
        found = ""
        while not self._problems.empty():
            found = self._problems.get_nowait()
        return found

    def wait(self) -> None:
        """Wait until every queued change has been written or has failed."""
        if self._thread:
            done = Event()
            self._tell(done)
            done.wait()

    def close(self, settings: Settings) -> None:
        """Write the settings one last time, and wait for the thread to end."""
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
            except Exception as error:  # the thread must live on, or `wait` never returns
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
