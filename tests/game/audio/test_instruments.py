from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from game.audio.instruments import GROUPS, INSTRUMENTS, RUNGS, altitude_key, rung
from game.audio.synth import RATE
from game.core.settings import Settings

LOOPS = [key for key, instrument in INSTRUMENTS.items() if instrument.loops]
SHORT = [key for key in INSTRUMENTS if key not in LOOPS]


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


def test_every_sound_has_its_level_and_no_offset(subtests):
    for key in INSTRUMENTS:
        with subtests.test(key=key):
            assert decibels(np.abs(sound(key)).max()) == pytest.approx(INSTRUMENTS[key].level, abs=0.1)
            assert np.abs(sound(key).mean(axis=0)).max() < 0.002
            assert INSTRUMENTS[key].group in GROUPS


def test_a_short_sound_begins_and_ends_in_silence(subtests):
    for key in SHORT:
        with subtests.test(key=key):
            assert np.abs(sound(key)[0]).max() < 0.002
            assert np.abs(sound(key)[-1]).max() < 0.002


@pytest.mark.parametrize("key", LOOPS)
def test_a_loop_has_no_seam(key):
    loop = sound(key)
    steps = np.abs(np.diff(loop, axis=0))
    assert np.abs(loop[0] - loop[-1]).max() < steps.max()
    across = np.concatenate([loop[-RATE // 10 :], loop[: RATE // 10]])
    bend = np.abs(np.diff(across, 2, axis=0)).max(axis=1)
    assert bend[RATE // 10 - 3 : RATE // 10 + 3].max() <= 1.5 * bend.max()  # nor a corner
    assert bend[RATE // 10 - 3 : RATE // 10 + 3].max() < 5 * bend.std() + bend.mean()


@pytest.mark.parametrize("key", ["engine", "crash", "altitude_3"])
def test_a_sound_is_the_same_every_time(key):
    assert np.array_equal(INSTRUMENTS[key].render(key), INSTRUMENTS[key].render(key))


def test_the_engine_rumbles_and_the_jets_hiss():
    assert band("engine", 0, 250) > 0.7
    assert band("engine", 0, 30) < 0.05  # no loudspeaker gives that back
    assert band("engine", 250, 2000) > 0.1  # what small loudspeakers give back
    assert band("jet_left", 700, 6000) > 0.75
    assert rms("jet_left") < rms("engine") - 8


def test_nothing_is_harsh(subtests):
    for key in INSTRUMENTS:
        with subtests.test(key=key):
            assert band(key, 5500, 22_050) < (0.2 if key.startswith("jet") else 0.03)


def test_each_jet_is_heard_on_its_own_side():
    left, right = (np.sqrt(np.mean(sound(key) ** 2, axis=0)) for key in ("jet_left", "jet_right"))
    assert left[0] > 2 * left[1]
    assert right[1] > 2 * right[0]


def test_the_pad_is_quiet_wide_and_moves_slowly():
    assert rms("pad") < rms("engine") - 4
    assert abs(np.corrcoef(sound("pad").T)[0, 1]) < 0.3
    seconds = np.sqrt(np.mean(sound("pad").reshape(24, -1) ** 2, axis=1))
    assert seconds.max() / seconds.min() < 3
    assert np.abs(np.diff(seconds)).max() / seconds.mean() < 0.6


def test_the_altitude_tone_climbs_evenly():
    notes = [rung(number) for number in range(RUNGS)]
    assert all(1.05 < high / low < 1.2 for low, high in pairwise(notes))
    for number in range(0, RUNGS, 5):
        assert (
            band(altitude_key(number), 0.97 * notes[number], 1.03 * notes[number]) > 0.4
        )  # the rest are its overtones


def test_the_busiest_moment_does_not_clip():
    """Even if the greatest samples of all met, at the volumes the game comes with; the altitude tone at full."""
    settings = Settings(altitude_volume=1.0)
    moments = [
        ("engine", "jet_left", "pad", "too_tilted", "altitude_0"),
        ("engine", "jet_left", "pad", "touchdown", "contact"),
        ("crash", "pad", "too_fast", "altitude_0", "engine"),
        ("landed", "touchdown", "contact", "pad", "choose"),
    ]
    for keys in moments:
        volumes = [getattr(settings, f"{INSTRUMENTS[key].group}_volume") ** 2 for key in keys]
        assert sum(volume * np.abs(sound(key)).max() for key, volume in zip(keys, volumes, strict=True)) < 1
