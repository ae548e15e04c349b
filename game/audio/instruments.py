"""Instruments: for every sound of the game, the function that makes it, its mixing group and its level.

All notes are of one key, the open fifths of D, so that sounds played together agree. Levels are peaks at full
volume; the loudest moment of a flight, all of it at once, still stays below full scale.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np
from numpy.typing import NDArray

from game.audio import synth
from game.audio.synth import Signal, band_pass, edges, glide, high_pass, low_pass, partials, sine, strike, together

GROUPS: Final = ("effects", "interface", "ambience")
_D4: Final = 293.66  # Hz
_BEDS: Final = 6.0  # seconds of a noise loop, long enough that its repetition is not heard
_PAD: Final = 24.0
_DETUNED: Final = 2 ** (9 / 1200) - 1  # standard deviation of a choir's tuning: nine cents


@dataclass(frozen=True)
class Instrument:
    """Recipe of one sound: how it is made and mixed."""

    make: Callable[[np.random.Generator], Signal]  # returns the sound, mono or stereo, at any level
    group: str  # the volume group, one of GROUPS
    level: float  # its peak, in dB below full scale
    loops: bool = False  # whether it repeats without a seam

    def render(self, key: str) -> NDArray[np.int16]:
        """Return the sound as 16-bit stereo (n, 2) for the mixer; the same every time for the same key."""
        signal = self.make(np.random.default_rng(list(key.encode())))
        return synth.pcm(synth.at_peak(signal, self.level))


def note(semitones: float) -> float:
    """Return the frequency in Hz of the note `semitones` above the D over middle C."""
    return _D4 * float(2 ** (semitones / 12))


# Engines


def _engine(rng: np.random.Generator) -> Signal:
    """Main engine: a rumble in the middle and a faint roar to both sides, with a slow flutter."""
    flutter = 1 + 0.16 * synth.noise(rng, _BEDS, band_pass(2.5, 9, 2))
    rumble = synth.noise(rng, _BEDS, lambda f: high_pass(36)(f) * low_pass(105, 1.5)(f))
    roar = [synth.noise(rng, _BEDS, lambda f: high_pass(90)(f) * low_pass(340, 1.25)(f)) for _ in range(2)]
    return np.stack([flutter * (rumble + 0.55 * side) for side in roar], axis=1)


def _jet(rng: np.random.Generator, pan: float) -> Signal:
    """Cold-gas jet: a soft hiss from the side of the jet."""
    shimmer = 1 + 0.10 * synth.noise(rng, _BEDS, band_pass(5, 20, 2))
    hiss = synth.noise(rng, _BEDS, lambda f: high_pass(700, 1.5)(f) * low_pass(2300, 1.25)(f))
    return synth.place(shimmer * hiss, pan)


# What happens to the craft


def _thud(rng: np.random.Generator) -> Signal:
    """Touch of a foot: a soft, low thud, and a short ring of the struts."""
    blow = sine(glide(112, 52, 0.5, 0.05), 0.5) * strike(0.5, 0.003, 0.42)
    dust = synth.noise(rng, 0.5, low_pass(420, 1)) * strike(0.5, 0.004, 0.30)
    struts = partials(311, ((1, 1, 0.16), (1.47, 0.7, 0.12), (2.63, 0.4, 0.08)), 0.5) * edges(0.5, 0.002, 0.02)
    return synth.room(rng, np.tanh(1.6 * (blow + 0.36 * dust + 0.16 * struts)), 0.7, 0.16)


def _bell(rng: np.random.Generator) -> Signal:
    """First contact: one clear, high note."""
    rows = ((1, 1, 1.3), (2.0, 0.35, 0.8), (2.76, 0.16, 0.5), (5.4, 0.04, 0.2))
    return synth.room(rng, partials(note(19), rows, 1.4) * edges(1.4, 0.004, 0.05), 1.2, 0.35)


def _landed(rng: np.random.Generator) -> Signal:
    """Landing: a rising chord, struck note by note."""
    struck = [synth.late(_mallet(semitones, 2.0), 0.14 * i) for i, semitones in enumerate((-12, -5, 2, 7, 14))]
    return synth.room(rng, together(*struck), 2.0, 0.45)


def _lost(rng: np.random.Generator) -> Signal:
    """Flight lost, out of the area or out of time: two falling notes."""
    return synth.room(rng, together(_mallet(-5, 1.2), synth.late(_mallet(-12, 1.6), 0.24)), 1.6, 0.4)


def _crash(rng: np.random.Generator) -> Signal:
    """Crash, in a large room: noise that grows duller as it fades, a low thud, and fragments that fall one by one."""
    bands = ((low_pass(160, 1), 1.0, 2.0), (band_pass(120, 900, 1), 0.5, 0.9), (band_pass(700, 3200, 1), 0.16, 0.3))
    blast = sum(gain * synth.noise(rng, 2.4, shape) * strike(2.4, 0.004, dies) for shape, gain, dies in bands)
    blow = sine(glide(84, 31, 1.2, 0.12), 1.2) * strike(1.2, 0.004, 1.1)
    fragments = []
    for delay in np.sort(rng.uniform(0.18, 1.7, 14)):
        rows = ((1, 1, 0.14), (1.58, 0.6, 0.10), (2.92, 0.3, 0.06))
        fragment = partials(float(rng.uniform(340, 1250)), rows, 0.2) * edges(0.2, 0.002, 0.02)
        quieter = float(rng.uniform(0.4, 1.0)) * 0.3 ** float(delay)
        fallen = synth.late(0.16 * quieter * fragment, float(delay))
        fragments.append(synth.place(fallen, float(rng.uniform(-0.7, 0.7))))
    body = together(synth.place(np.asarray(blast), 0.0), synth.place(1.7 * blow, 0.0), *fragments)
    return synth.room(rng, np.tanh(body), 2.2, 0.4)  # slight overdrive: dense, not sharp


# Warnings


def _too_fast(_: np.random.Generator) -> Signal:
    """Warning of a fall that is too fast: two short, falling notes."""
    return together(_beep(14, 0.10), synth.late(_beep(9, 0.13), 0.12))


def _too_tilted(_: np.random.Generator) -> Signal:
    """Warning of a tilt that is too great: one lower note that moves from side to side."""
    time = synth.clock(0.5)
    sway = np.sin(2 * np.pi * 6 * time)
    tone = sine(note(2) * 2 ** (0.7 * sway / 12), 0.5)
    angle = 0.25 * np.pi * (1 + 0.6 * sway)
    voice = (tone + 0.12 * tone**3) * edges(0.5, 0.03, 0.08)
    return np.stack([voice * np.cos(angle), voice * np.sin(angle)], axis=1)


def _edge(_: np.random.Generator) -> Signal:
    """Warning of the area's edge: two low, soft knocks on one note."""
    return together(_mallet(-12, 0.5), synth.late(_mallet(-12, 0.5), 0.16))


# The interface


def _tick(_: np.random.Generator, semitones: float, seconds: float) -> Signal:
    """Click of the interface: a very short, wooden note."""
    wood = partials(note(semitones), ((1, 1, 1.6 * seconds), (2.4, 0.22, 0.7 * seconds)), seconds)
    return wood * edges(seconds, 0.002, 0.012)


def _steps(rng: np.random.Generator, notes: tuple[float, float]) -> Signal:
    """Interface sound of two soft notes, up or down."""
    first, second = (partials(note(n), ((1, 1, 0.30), (2, 0.18, 0.16)), 0.26) * edges(0.26, 0.003, 0.03) for n in notes)
    return synth.room(rng, together(first, synth.late(second, 0.07)), 0.5, 0.2)


# Ambience


def _choir(rng: np.random.Generator, frequency: float) -> Signal:
    """Many voices on one note, each a little out of tune.

    Every harmonic is a bell-shaped band of noise, wider the higher it is: PADsynth, by N. O. Paul (2005).
    """

    def bells(f: Signal) -> Signal:
        harmonics = [
            number**-2.2 * np.exp(-0.5 * ((f / (number * frequency) - 1) / _DETUNED) ** 2) for number in range(1, 7)
        ]
        return np.asarray(np.sum(harmonics, axis=0))

    return synth.noise(rng, _PAD, bells)


def _pad(rng: np.random.Generator) -> Signal:
    """Ambient pad: open fifths over D; every note is a choir that swells at its own pace."""
    turns, notes = synth.clock(_PAD) / _PAD, ((-24, 0.8), (-17, 1.0), (-12, 0.9), (-5, 0.7), (2, 0.5), (9, 0.22))

    def side() -> Signal:
        total = np.zeros(len(turns))
        for number, (semitones, gain) in enumerate(notes):
            swell = 1 + 0.6 * np.cos(2 * np.pi * ((1 + number % 3) * turns + number / 6))
            total += gain * swell * _choir(rng, note(semitones))
        return total

    return np.stack([side(), side()], axis=1)


def _mallet(semitones: float, seconds: float) -> Signal:
    rows = ((1, 1, seconds), (2, 0.22, 0.5 * seconds), (4, 0.06, 0.2 * seconds))
    return partials(note(semitones), rows, seconds) * edges(seconds, 0.006, 0.1)


def _beep(semitones: float, seconds: float) -> Signal:
    tone = sine(note(semitones), seconds)
    return (tone + 0.15 * tone**3) * edges(seconds, 0.012, 0.03)


# In the order in which they are synthesised: sounds needed early come first.
INSTRUMENTS: Final[dict[str, Instrument]] = {
    "move": Instrument(partial(_tick, semitones=26, seconds=0.035), "interface", -19),
    "choose": Instrument(partial(_steps, notes=(14, 21)), "interface", -17),
    "back": Instrument(partial(_steps, notes=(14, 7)), "interface", -18),
    "adjust": Instrument(partial(_tick, semitones=21, seconds=0.03), "interface", -19),
    "to_network": Instrument(partial(_steps, notes=(9, 16)), "interface", -17),
    "to_human": Instrument(partial(_steps, notes=(9, 2)), "interface", -17),
    "engine": Instrument(_engine, "effects", -11, loops=True),
    "jet_left": Instrument(partial(_jet, pan=-0.55), "effects", -20, loops=True),
    "jet_right": Instrument(partial(_jet, pan=0.55), "effects", -20, loops=True),
    "pad": Instrument(_pad, "ambience", -18, loops=True),
    "too_fast": Instrument(_too_fast, "effects", -20),
    "too_tilted": Instrument(_too_tilted, "effects", -17),
    "edge": Instrument(_edge, "effects", -16),
    "touchdown": Instrument(_thud, "effects", -9),
    "contact": Instrument(_bell, "effects", -15),
    "crash": Instrument(_crash, "effects", -6),
    "landed": Instrument(_landed, "effects", -12),
    "lost": Instrument(_lost, "effects", -15),
}
