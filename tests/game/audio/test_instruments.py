from functools import cache

import numpy as np
import pytest

from game.audio import synth
from game.audio.instruments import GROUPS, INSTRUMENTS
from game.audio.synth import RATE
from game.core.settings import Settings

LOOPS = [key for key, instrument in INSTRUMENTS.items() if instrument.loops]


@cache
def sound(key):
    return INSTRUMENTS[key].render(key) / 32_767


def decibels(gain):
    return 20 * np.log10(gain)


def band(key, low, high):
    """The share of a sound's power between two frequencies."""
    power = (np.abs(np.fft.rfft(sound(key), axis=0)) ** 2).sum(axis=1)
    frequency = np.fft.rfftfreq(len(sound(key)), 1 / RATE)
    return power[(frequency >= low) & (frequency < high)].sum() / power.sum()


def rms(key):
    return decibels(np.sqrt(np.mean(sound(key) ** 2)))


@pytest.mark.slow
def test_every_sound_has_its_level_no_offset_nothing_harsh_and_a_short_one_begins_and_ends_in_silence():
    for key, instrument in INSTRUMENTS.items():
        assert decibels(np.abs(sound(key)).max()) == pytest.approx(instrument.level, abs=0.1), key
        assert np.abs(sound(key).mean(axis=0)).max() < 0.002, key
        assert band(key, 5500, 22_050) < (0.2 if key.startswith("jet") else 0.03), key
        assert instrument.group in GROUPS
        if key not in LOOPS:
            assert np.abs(sound(key)[[0, -1]]).max() < 0.002, key


@pytest.mark.parametrize("key", LOOPS)
def test_a_loop_has_no_seam(key):
    loop = sound(key)
    steps = np.abs(np.diff(loop, axis=0))
    assert np.abs(loop[0] - loop[-1]).max() < steps.max()
    across = np.concatenate([loop[-RATE // 10 :], loop[: RATE // 10]])
    bend = np.abs(np.diff(across, 2, axis=0)).max(axis=1)
    assert bend[RATE // 10 - 3 : RATE // 10 + 3].max() <= 1.5 * bend.max()  # nor a corner
    assert bend[RATE // 10 - 3 : RATE // 10 + 3].max() < 5 * bend.std() + bend.mean()


def test_a_sound_is_the_same_every_time():
    for key in ("engine", "choose"):
        assert np.array_equal(INSTRUMENTS[key].render(key) / 32_767, sound(key))


def test_the_engine_rumbles_and_the_jets_hiss():
    assert band("engine", 0, 250) > 0.7
    assert band("engine", 0, 30) < 0.05  # no loudspeaker gives that back
    assert band("engine", 250, 2000) > 0.1  # what small loudspeakers give back
    assert band("jet_left", 700, 6000) > 0.75
    assert rms("jet_left") < rms("engine") - 8


def test_each_jet_is_heard_on_its_own_side():
    left, right = (np.sqrt(np.mean(sound(key) ** 2, axis=0)) for key in ("jet_left", "jet_right"))
    assert left[0] > 2 * left[1]
    assert right[1] > 2 * right[0]


@pytest.mark.slow
def test_the_busiest_moment_does_not_clip():
    """Even if the greatest samples of all met, at the volumes the game comes with."""
    settings = Settings()
    moments = [
        ("engine", "jet_left", "pad", "too_tilted"),
        ("engine", "jet_left", "pad", "touchdown", "contact"),
        ("crash", "pad", "too_fast", "engine"),
        ("landed", "touchdown", "contact", "pad", "choose"),
    ]
    for keys in moments:
        volumes = [getattr(settings, f"{INSTRUMENTS[key].group}_volume") ** 2 for key in keys]
        assert sum(volume * np.abs(sound(key)).max() for key, volume in zip(keys, volumes, strict=True)) < 1


def spectrum(signal):
    """Frequencies, and the power at each."""
    return np.fft.rfftfreq(len(signal), 1 / RATE), np.abs(np.fft.rfft(signal)) ** 2


def power_between(signal, low, high):
    frequency, power = spectrum(signal)
    return power[(frequency >= low) & (frequency < high)].sum() / power.sum()


def rng(seed=1):
    return np.random.default_rng(seed)


def seam(loop):
    """The step from the end of a loop to its beginning, in standard deviations of its other steps."""
    return np.abs(loop[0] - loop[-1]).max() / np.diff(loop, axis=0).std()


@pytest.mark.parametrize("frequency", [110.0, 1000.0, 5000.0])
def test_a_sine_is_one_line_at_its_frequency(frequency):
    signal = synth.sine(frequency, 1.0)
    assert signal[0] == 0
    assert power_between(signal, frequency - 1, frequency + 1) > 0.999
    assert np.sqrt(np.mean(signal**2)) == pytest.approx(1 / np.sqrt(2), rel=1e-3)


def test_filters_pass_half_the_power_at_their_cut():
    cut = np.array([500.0])
    for gain in (synth.low_pass(500, 3), synth.high_pass(500, 1)):
        assert gain(cut) ** 2 == pytest.approx(0.5)
    octaves = synth.low_pass(500, 2)(np.array([4000.0, 8000.0]))
    assert decibels(octaves[1] / octaves[0]) == pytest.approx(-12, abs=0.1)


def test_noise_has_the_spectrum_asked_for_and_no_seam():
    signal = synth.noise(rng(), 2.0, synth.band_pass(400, 800, 4))
    assert len(signal) == 2 * RATE
    assert np.sqrt(np.mean(signal**2)) == pytest.approx(1)
    assert power_between(signal, 300, 1100) > 0.95
    assert seam(signal) < 5
    assert np.mean(signal**4) == pytest.approx(3, abs=0.2), "a normal distribution's kurtosis: no tone"


def test_the_pad_is_a_chord_that_swells_and_goes_round():
    pad = sound("pad")[:, 0]
    low = power_between(pad, 70, 460)
    assert low > 0.7
    for semitones in (-24, -17, -12, -5):
        fundamental = 293.66 * 2 ** (semitones / 12)
        assert power_between(pad, 0.98 * fundamental, 1.02 * fundamental) > 0.04
    loudness = np.sqrt(np.mean((pad**2).reshape(48, -1), axis=1))
    assert loudness.max() > 1.3 * loudness.min()


@pytest.mark.parametrize("envelope", [synth.strike(0.3, 0.01, 0.2), synth.edges(0.3, 0.01, 0.05)])
def test_envelopes_begin_and_end_at_nothing_and_never_jump(envelope):
    assert envelope[0] == pytest.approx(0, abs=1e-9)
    assert envelope[-1] == pytest.approx(0, abs=1e-9)
    assert 0 <= envelope.min() < envelope.max() <= 1
    assert np.abs(np.diff(envelope)).max() < 0.005


def test_panning_keeps_the_power():
    for pan in (-1.0, -0.4, 0.0, 0.7, 1.0):
        left, right = synth.place(np.ones(4), pan).T
        assert left**2 + right**2 == pytest.approx(np.full(4, 2.0))
        assert (np.sign(np.round(right - left, 9)) == np.sign(pan)).all()


def test_a_room_answers_both_ears_differently_and_dies_away():
    click = np.zeros(100)
    click[0] = 1.0
    heard = synth.room(rng(), click, 0.5, 0.8)
    assert heard[0] == pytest.approx([1, 1])  # the sound itself comes first, untouched
    echo = heard[1:]
    assert (echo**2).sum() == pytest.approx(2 * 0.8**2, rel=0.01)
    assert abs(np.corrcoef(*echo.T)[0, 1]) < 0.2
    tenths = [(echo[begin : begin + RATE // 10] ** 2).sum() for begin in range(0, len(echo), RATE // 10)]
    assert tenths == sorted(tenths, reverse=True)
    longer = synth.room(rng(), np.ones(RATE // 10), 0.2, 0.5)
    assert len(longer) == RATE // 10 + round(0.212 * RATE), "a convolution is never cut off"
    assert np.abs(longer[-5:]).max() < 1e-3


def test_what_would_be_clipped_is_refused():
    for wrong in (1.01, -1.5, np.nan, np.inf):
        with pytest.raises(ValueError, match="full scale"):
            synth.pcm(np.array([0.0, wrong]))
