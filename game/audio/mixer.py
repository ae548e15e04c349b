"""Mixer of the game: plays the instruments of `game.audio`, and stays silent without a sound device."""

from __future__ import annotations

import contextlib
import logging
import threading
from collections.abc import Callable, Mapping
from functools import wraps
from typing import Final, TypeVar, cast

import numpy as np
import pygame
from numpy.typing import NDArray

from game.audio.instruments import GROUPS, INSTRUMENTS, Instrument
from game.audio.synth import RATE
from game.core.settings import Settings

_BUFFER: Final = 512  # samples per buffer of the device: 12 ms of latency
_VOICES: Final = 16  # short sounds playing at once
_APART: Final = 3  # steps within which the same sound is not started again
_EASE: Final = 0.3  # share of the difference to its volume that a loop makes up in a step
_SWELL: Final = 0.015  # the same for ambience fading in; it fades out more quickly
_GO: Final = 0.12
_SILENT: Final = 0.002
_FADE: Final = 120  # milliseconds
_log = logging.getLogger("tranquility")
_Method = TypeVar("_Method", bound=Callable[..., None])


def _while_open(method: _Method) -> _Method:
    """Decorate a method to run only while there is a device; release one that fails, and go on in silence."""

    @wraps(method)
    def attempt(self: Sound, *args: object, **kwargs: object) -> None:
        if not self.ready:
            return
        try:
            method(self, *args, **kwargs)
        except pygame.error as error:
            self.problem = str(error)
            self._let_go()

    return cast(_Method, attempt)


class Sound:
    """Mixer that plays sounds by their keys in `instruments`; silent until it is opened, and without a device.

    The sounds are synthesised in a thread of their own; one that is not ready yet is not played.

    Attributes:
        ready: whether a device is open.
        problem: why no device is open; empty if one is.
        gains: gain of each group of sounds, 0 to 1.

    """

    def __init__(self, instruments: Mapping[str, Instrument] = INSTRUMENTS) -> None:
        self.ready, self.problem = False, ""
        self._instruments = instruments
        self._loops = [key for key, instrument in instruments.items() if instrument.loops]
        self.gains = dict.fromkeys(GROUPS, 1.0)
        self._waves: dict[str, NDArray[np.int16]] = {}
        self._sounds: dict[str, pygame.mixer.Sound] = {}
        self._asked: dict[str, float] = {}
        self._levels = dict.fromkeys(self._loops, 0.0)
        self._begun: dict[str, int] = {}  # the step in which a short sound was last played
        self._step = 0
        self._wanted = self._muted = False
        self._studio: threading.Thread | None = None
        self._closing = threading.Event()

    def open(self) -> bool:
        """Open the sound device and start synthesis. Return False without a device, which is no error."""
        self._wanted = True
        try:
            pygame.mixer.init(RATE, -16, 2, _BUFFER, allowedchanges=0)
            pygame.mixer.set_num_channels(len(self._loops) + _VOICES)
            pygame.mixer.set_reserved(len(self._loops))
        except (pygame.error, NotImplementedError) as error:  # NotImplementedError: pygame was built without a mixer
            self.problem = str(error)
            return False
        self.ready, self.problem = True, ""
        if self._studio is None:
            self._studio = threading.Thread(target=self._synthesise, name="sounds", daemon=True)
            self._studio.start()
        return True

    def close(self) -> None:
        """Stop synthesis and all sounds, and release the device."""
        self._wanted = False
        self._closing.set()
        if self._studio is not None:
            self._studio.join()
        if self.ready:
            self._let_go()

    def follow(self, settings: Settings) -> None:
        """Take the volumes from the settings, squared: loudness is heard in ratios, so half way up is a gain of 1/4."""
        master = 0.0 if settings.muted else settings.master_volume
        self.gains = {group: (master * getattr(settings, f"{group}_volume")) ** 2 for group in GROUPS}
        if settings.muted:
            self._fade_out()

    def handle_event(self, event: pygame.event.Event) -> None:
        """Mute while the window has no focus; follow devices that are plugged in or removed."""
        match event.type:
            case pygame.WINDOWFOCUSLOST | pygame.WINDOWMINIMIZED:
                self._muted = True
                self._fade_out()
            case pygame.WINDOWFOCUSGAINED | pygame.AUDIODEVICEADDED:
                self._muted = self._muted and event.type == pygame.AUDIODEVICEADDED
                if self._wanted and not self.ready:
                    self.open()
            case pygame.AUDIODEVICEREMOVED if self.ready and not event.iscapture:
                self._let_go()
                self.open()  # on another device, if any

    @_while_open
    def play(self, key: str, volume: float = 1.0) -> None:
        """Play a short sound once; `volume` is 0 to 1."""
        gain = volume * self.gains[self._instruments[key].group]
        since = self._step - self._begun.get(key, -_APART)
        sound = self._sound(key)
        if self._muted or gain < _SILENT or since < _APART or sound is None:
            return
        channel = sound.play()  # never one of the channels reserved for loops
        if channel is not None:
            channel.set_volume(min(gain, 1.0))
            self._begun[key] = self._step

    def loop(self, key: str, volume: float) -> None:
        """Keep a loop playing at this volume, 0 to 1, in this step; a loop not requested again fades out."""
        self._asked[key] = max(volume, self._asked.get(key, 0.0))

    @_while_open
    def update(self) -> None:
        """Advance the fades by 1/60 s."""
        self._step += 1
        asked, self._asked = self._asked, {}
        for number, key in enumerate(self._loops):
            always = self._instruments[key].group == "ambience"
            wanted = 0.0 if self._muted else 1.0 if always else asked.get(key, 0.0)
            level = self._levels[key]
            ease = _EASE if not always else _SWELL if wanted > level else _GO
            self._levels[key] = level + ease * (wanted - level)
            self._keep_going(number, key)

    def _keep_going(self, number: int, key: str) -> None:
        """Play a loop at its level, on a channel of its own."""
        gain = self._levels[key] * self.gains[self._instruments[key].group]
        channel, sound = pygame.mixer.Channel(number), self._sound(key)
        if sound is None:
            self._levels[key] = 0.0
        elif gain < _SILENT:
            channel.stop()
        else:
            sound.set_volume(gain)
            if not channel.get_busy():
                channel.play(sound, loops=-1)

    def _sound(self, key: str) -> pygame.mixer.Sound | None:
        """Return a sound for the mixer; None until it has been synthesised."""
        if key not in self._sounds and key in self._waves:
            self._sounds[key] = pygame.mixer.Sound(buffer=self._waves[key].tobytes())
        return self._sounds.get(key)

    def _synthesise(self) -> None:
        """Synthesise one sound after another, in the thread; one that fails is left out."""
        for key, instrument in self._instruments.items():
            if self._closing.is_set():
                return
            try:
                self._waves[key] = instrument.render(key)
            except Exception:
                _log.exception("making the sound %s", key)

    @_while_open
    def _fade_out(self) -> None:
        for number in range(len(self._loops), pygame.mixer.get_num_channels()):
            pygame.mixer.Channel(number).fadeout(_FADE)

    def _let_go(self) -> None:
        """Release the device; the synthesised sounds are kept for the next one."""
        self.ready = False
        self._sounds.clear()
        self._levels = dict.fromkeys(self._loops, 0.0)
        with contextlib.suppress(pygame.error):
            pygame.mixer.quit()
