"""Lander run that an experiment can fly beside: two workers, one seed, in step by decisions."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from ai.training.config import Config
from ai.training.history import Checkpoint
from ai.training.messages import AutosaveTo
from ai.training.session import live
from game.core import texts
from game.core.names import LibraryError
from game.core.worker import Worker
from game.training.lander_run import PACES, LanderRun
from game.training.library import Library

AHEAD: Final = 12  # turns that either may be ahead of the slower: enough to work on between two frames


class Twin(LanderRun):
    """Run of an experiment. It writes nothing to the disk: its twin has the place of the run without a name."""

    def _begin(self, config: Config, seed: int, resume: Path | None) -> str:  # noqa: ARG002 - it starts anew
        self._worker = Worker(live, config, seed)
        self._worker.set_pace(PACES[self.pace])
        return ""


class SplitRun(LanderRun):
    """Lander runs, one after another; beside each, on request, an experiment from the same seed.

    The faster of the two waits, so that both have taken as many turns, which are decisions of every lander: on any
    machine, what differs is what was changed. If one of them ends or fails, the other goes on alone, and at full pace.

    Attributes:
        twin: the experiment; None without one.
        differing: names of the settings in which the experiment differs.

    """

    def __init__(self, library: Library) -> None:
        super().__init__(library)
        self.twin: Twin | None = None
        self.differing: tuple[str, ...] = ()
        self._leaving: Worker | None = None  # of a healthy run whose place the experiment takes
        self._limit: int | None = None

    @property
    def turns(self) -> tuple[int, int]:
        """Turns that this run and the experiment have taken."""
        runs = (self, self.twin) if self.twin else (self, self)
        first, second = (each.swarm_state.decisions // each.config.num_envs if each.swarm_state else 0 for each in runs)
        return first, second

    def split(self, config: Config, seed: int, experiment: Config, differing: tuple[str, ...], name: str) -> str:
        """Start a run, and an experiment beside it; return a note for the player, or ""."""
        note = self.begin(config, seed, name=name)
        self.twin, self.differing = Twin(self.library), differing
        self.twin.pace = self.pace
        self.twin.begin(experiment, seed)
        self._keep_in_step()
        return note

    def begin(self, config: Config, seed: int, resume: Path | None = None, name: str = "") -> str:
        """Start a run, or resume a saved one, without an experiment beside it."""
        self.leave()
        return super().begin(config, seed, resume, name)

    def leave(self) -> None:
        """End the experiment; the run goes on."""
        if self.twin is not None:
            self.twin.close()
            self.twin, self.differing = None, ()
            self._keep_in_step()

    def keep_twin(self) -> str:
        """Go on with the experiment in place of the run, whose curves stay beside; its network can be restored.

        Returns a note for the player, or "": an experiment that has ended cannot be kept, and nothing changes then.
        """
        twin = self.twin
        if twin is None or not twin.alive or twin._worker is None or self._worker is None:
            return texts.SPLIT_OVER
        self._put_beside(self.name, self.history)
        self._leaving, self._worker = self._worker, twin._worker
        self._leaving.stop()
        self.runs += 1
        self._named = False
        self.history, self.config, self.seed = twin.history, twin.config, twin.seed
        self.swarm_state, self.network_state = twin.swarm_state, twin.network_state
        self.swarms, self.networks, self.edits = twin.swarms, twin.networks, twin.edits
        self.in_force, self.lesson, self.begun = twin.in_force, None, True
        twin._worker, self.twin, self.differing = None, None, ()
        self._keep_in_step()
        return ""

    def poll(self) -> list[str]:
        """Handle all messages of both workers; return notes for the player."""
        notes = super().poll()
        if self.twin is not None:
            notes += self.twin.poll()
        if self._leaving is not None:
            self._leaving.poll()
            if self._leaving.gone:
                self._take_place()
        self._keep_in_step()
        return notes

    def _take_place(self) -> None:
        """Let the experiment save itself in place of the run that has ended."""
        self._leaving = None
        with suppress(LibraryError):  # then it replaces what is there
            self.library.discard_rescued()
        self._send(AutosaveTo(self.library.unsaved))

    def _keep_in_step(self) -> None:
        """Allow both runs as many turns, a few more than the slower one has taken."""
        together = self.twin is not None and self.alive and self.twin.alive
        limit = min(self.turns) + AHEAD if together else None
        if limit != self._limit:
            self._limit = limit
            for run in filter(None, (self, self.twin)):
                run._ask(lambda worker: worker.set_limit(limit))

    # Requests to both

    def pause(self) -> None:
        """Pause both runs."""
        super().pause()
        if self.twin:
            self.twin.pause()

    def resume(self) -> None:
        """Resume both runs."""
        super().resume()
        if self.twin:
            self.twin.resume()

    def step(self) -> None:
        """Take one learning step in both runs, then pause."""
        super().step()
        if self.twin:
            self.twin.step()

    def set_pace(self, index: int) -> None:
        """Choose one of `PACES` by its index, for both runs."""
        super().set_pace(index)
        if self.twin:
            self.twin.set_pace(index)

    def change(self, name: str, value: Any) -> None:
        """Change a live setting of both runs; one in which the experiment differs, of the run alone."""
        super().change(name, value)
        if self.twin and name not in self.differing:
            self.twin.change(name, value)

    def teach(self, demonstrations: Path) -> None:
        """Let both runs also learn from a file of demonstrations."""
        super().teach(demonstrations)
        if self.twin:
            self.twin.teach(demonstrations)

    def revert(self, checkpoint: Checkpoint) -> None:
        """Revert the networks of both runs to the checkpoints of one moment."""
        super().revert(checkpoint)
        if self.twin:
            self.twin.revert(checkpoint)

    def close(self) -> None:
        """End the runs and their processes for certain."""
        if self._leaving is not None:
            self._leaving.close(self.grace)
            self._take_place()
        if self.twin:
            self.twin.close()
        super().close()
