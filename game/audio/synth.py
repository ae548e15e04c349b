"""Sound synthesis with arrays: oscillators, filters, noise, envelopes and reverberation.

A signal holds floats between -1 and 1, RATE of them a second: mono (n,), or stereo (n, 2) with the left side
first. A loop has no seam because it holds whole periods only: noise is made as a spectrum, whose inverse Fourier
transform is periodic.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

Signal = NDArray[np.float64]
Gain = Callable[[Signal], Signal]  # gain as a function of frequencies in Hz, all above zero

RATE: Final = 44_100
_ROOM_BRIGHTNESS: Final = 2600.0  # Hz, above which walls absorb more than they reflect
_PRE_DELAY: Final = 0.012  # seconds until the first reflection


def clock(seconds: float) -> Signal:
    """Return the times of a signal's samples, in seconds."""
    return np.arange(round(seconds * RATE)) / RATE


# Oscillators


def sine(frequency: float | Signal, seconds: float) -> Signal:
    """Return a sine that begins at zero; its frequency in Hz may change from sample to sample, (n,)."""
    turns = np.cumsum(np.broadcast_to(frequency, round(seconds * RATE)) / RATE)
    return np.asarray(np.sin(2 * np.pi * (turns - turns[0])))


def glide(start: float, end: float, seconds: float, halving: float) -> Signal:
    """Return frequencies in Hz that approach `end` from `start`; the difference halves every `halving` seconds."""
    return np.asarray(end + (start - end) * 0.5 ** (clock(seconds) / halving))


def partials(frequency: float, rows: Sequence[tuple[float, float, float]], seconds: float) -> Signal:
    """Return a sum of decaying sines: rows of ratio to the frequency, amplitude, seconds until a thousandth."""
    time = clock(seconds)
    rung = [gain * sine(ratio * frequency, seconds) * 0.001 ** (time / dies) for ratio, gain, dies in rows]
    return np.asarray(np.sum(rung, axis=0))


# Filters, as gains over frequency


def low_pass(cut: float, order: float = 2) -> Gain:
    """Return a Butterworth low-pass filter's gain; half the power is left at `cut` Hz."""
    return lambda frequency: 1 / np.sqrt(1 + (frequency / cut) ** (2 * order))


def high_pass(cut: float, order: float = 2) -> Gain:
    """Return a Butterworth high-pass filter's gain; half the power is left at `cut` Hz."""
    return lambda frequency: 1 / np.sqrt(1 + (cut / frequency) ** (2 * order))


def band_pass(low: float, high: float, order: float = 2) -> Gain:
    """Return the gain of a high-pass and a low-pass filter in a row."""
    return lambda frequency: high_pass(low, order)(frequency) * low_pass(high, order)(frequency)


# Loops


def noise(rng: np.random.Generator, seconds: float, gain: Gain) -> Signal:
    """Return a seamless loop of noise, filtered by `gain`, root mean square 1."""
    count = round(seconds * RATE)
    spectrum = np.zeros(count // 2 + 1, np.complex128)
    frequency: Signal = np.fft.rfftfreq(count, 1 / RATE)[1:].astype(np.float64)
    spectrum[1:] = gain(frequency) * np.exp(2j * np.pi * rng.random(len(frequency)))
    loop = np.asarray(np.fft.irfft(spectrum, count), np.float64)
    return np.asarray(loop / np.sqrt(np.mean(loop**2)))


# Envelopes


def strike(seconds: float, attack: float, dies: float) -> Signal:
    """Return an envelope that rises in `attack` seconds and decays to a thousandth in `dies`; it ends at zero."""
    time = clock(seconds)
    return np.asarray(0.001 ** (time / dies) * edges(seconds, attack, min(0.25 * seconds, 0.02)))


def edges(seconds: float, rise: float, fall: float) -> Signal:
    """Return an envelope of 1 with half-cosine fades to 0 at both ends, so that a cut sound does not click."""
    time = clock(seconds)
    ends = np.minimum(time / rise, (time[-1] - time) / fall)
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * np.clip(ends, 0.0, 1.0)))


def late(signal: Signal, delay: float) -> Signal:
    """Return a signal delayed by `delay` seconds."""
    return np.concatenate([np.zeros((round(delay * RATE), *signal.shape[1:])), signal])


def together(*signals: Signal) -> Signal:
    """Return the sum of signals of any lengths, all mono or all stereo."""
    whole = np.zeros((max(map(len, signals)), *signals[0].shape[1:]))
    for signal in signals:
        whole[: len(signal)] += signal
    return whole


# Space


def place(signal: Signal, pan: float) -> Signal:
    """Return a mono signal panned to stereo, from -1, left, to 1, right, with equal power everywhere."""
    angle = 0.25 * np.pi * (1 + pan)
    return np.asarray(np.sqrt(2) * signal[:, None] * (np.cos(angle), np.sin(angle)))


def room(rng: np.random.Generator, signal: Signal, seconds: float, wet: float) -> Signal:
    """Return a mono or stereo signal with the reverberation of a room that decays in `seconds`; stereo.

    The impulse response is exponentially decaying noise, different for each ear, as in J. A. Moorer, "About this
    reverberation business", Computer Music Journal 3 (1979); `wet` is its energy relative to the signal's own.
    """
    dry = place(signal, 0.0) if signal.ndim == 1 else signal
    count = len(dry) + round((seconds + _PRE_DELAY) * RATE)
    decay = 0.001 ** (clock(seconds) / seconds) * edges(seconds, 0.004, 0.02)
    walls = [decay * noise(rng, seconds, low_pass(_ROOM_BRIGHTNESS, 1)) for _ in range(2)]
    answer = late(np.stack([wall / np.linalg.norm(wall) for wall in walls], axis=1), _PRE_DELAY)
    size = 1 << (count - 1).bit_length()  # which has a fast Fourier transform
    echo = np.fft.irfft(np.fft.rfft(dry, size, axis=0) * np.fft.rfft(answer, size, axis=0), size, axis=0)[:count]
    return together(dry, wet * echo)


# Levels


def at_peak(signal: Signal, level: float) -> Signal:
    """Return a signal whose greatest sample is at a level in dB below full scale; silence stays silence."""
    peak = np.abs(signal).max(initial=0.0)
    return np.asarray(signal * (10 ** (level / 20) / peak) if peak else signal)


def pcm(signal: Signal) -> NDArray[np.int16]:
    """Return a signal as 16-bit stereo samples (n, 2) for a mixer.

    Raises:
        ValueError: a sample lies beyond full scale, or is NaN.

    """
    if not np.abs(signal).max(initial=0.0) <= 1:  # written so that NaN fails too
        raise ValueError("a signal lies beyond full scale")
    stereo = place(signal, 0.0) if signal.ndim == 1 else signal
    return np.ascontiguousarray(np.round(32_767 * stereo).astype(np.int16))
