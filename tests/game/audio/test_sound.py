"""The mixer, with SDL's driver that plays to nobody; sounds are short work here."""

import threading
from collections.abc import Iterator
from typing import Any

import numpy as np
import pygame
import pytest

from game.audio.instruments import Instrument
from game.audio.mixer import Sound
from game.core.settings import Settings

ENGINE, PAD, FIRST_VOICE = 0, 1, 2


def hum(rng: np.random.Generator) -> np.ndarray:
    return np.sin(np.arange(44_100) / 20)


def broken(rng: np.random.Generator) -> np.ndarray:
    raise ValueError("out of tune")


INSTRUMENTS = {
    "engine": Instrument(hum, "effects", -12, loops=True),
    "pad": Instrument(hum, "ambience", -12, loops=True),
    "bell": Instrument(hum, "effects", -12),
    "click": Instrument(hum, "interface", -12),
    "broken": Instrument(broken, "effects", -12),
    "silence": Instrument(lambda rng: np.zeros(100), "effects", -12),
}
LOST = pygame.event.Event(pygame.WINDOWFOCUSLOST)
GAINED = pygame.event.Event(pygame.WINDOWFOCUSGAINED)
REMOVED = pygame.event.Event(pygame.AUDIODEVICEREMOVED, which=2, iscapture=0)
ADDED = pygame.event.Event(pygame.AUDIODEVICEADDED, which=0, iscapture=0)


@pytest.fixture
def sound() -> Iterator[Sound]:
    opened = Sound(INSTRUMENTS)
    assert opened.open()
    made()
    yield opened
    opened.close()


def made() -> None:
    """Wait until every sound is made."""
    for thread in threading.enumerate():
        if thread.name == "sounds":
            thread.join()


def steps(sound: Sound, number: int, **loops: float) -> None:
    for _ in range(number):
        for key, volume in loops.items():
            sound.loop(key, volume)
        sound.update()


def level(number: int) -> float:
    """How loud a channel is."""
    channel = pygame.mixer.Channel(number)
    playing = channel.get_sound()
    return playing.get_volume() * channel.get_volume() if playing and channel.get_busy() else 0.0


def voices() -> int:
    return sum(pygame.mixer.Channel(n).get_busy() for n in range(FIRST_VOICE, pygame.mixer.get_num_channels()))


def test_a_loop_follows_the_volume_it_is_asked_for_and_dies_away_unasked(sound: Sound):
    steps(sound, 1, engine=1.0)
    assert 0 < level(ENGINE) < 0.5  # it does not jump
    steps(sound, 30, engine=1.0)
    assert level(ENGINE) == pytest.approx(1.0, abs=0.02)
    steps(sound, 30, engine=0.4)
    assert level(ENGINE) == pytest.approx(0.4, abs=0.02)
    steps(sound, 3)
    assert 0 < level(ENGINE) < 0.4
    steps(sound, 30)
    assert level(ENGINE) == 0


def test_ambience_comes_in_slowly_and_stays_by_itself(sound: Sound):
    steps(sound, 10)
    assert 0 < level(PAD) < 0.2
    steps(sound, 600)
    assert level(PAD) == pytest.approx(1.0, abs=0.02)


def test_volumes_are_separate_and_act_at_once(sound: Sound):
    steps(sound, 400, engine=1.0)
    sound.follow(Settings(effects_volume=0.5, ambience_volume=0.0))
    steps(sound, 1, engine=1.0)
    assert level(ENGINE) == pytest.approx(0.25, abs=0.02)
    assert level(PAD) == 0
    sound.follow(Settings(effects_volume=0.0, interface_volume=1.0))
    sound.play("bell")
    assert voices() == 0
    sound.play("click")
    assert voices() == 1


def test_the_same_sound_twice_at_once_is_one(sound: Sound):
    sound.play("bell")
    sound.play("bell")
    assert voices() == 1
    for _ in range(40):
        steps(sound, 3)
        sound.play("bell")
    assert voices() == pygame.mixer.get_num_channels() - FIRST_VOICE, "more than voices are no error"


def test_an_instrument_that_fails_is_not_heard_and_the_others_are(sound: Sound):
    sound.play("broken")
    assert voices() == 0
    sound.play("silence")
    sound.play("bell")
    assert voices() >= 1


@pytest.mark.parametrize("event", [LOST, pygame.event.Event(pygame.WINDOWMINIMIZED)])
def test_a_window_not_in_use_is_silent(sound: Sound, event: pygame.event.Event):
    steps(sound, 200, engine=1.0)
    sound.handle_event(event)
    sound.play("bell")
    assert voices() == 0
    steps(sound, 60, engine=1.0)
    assert level(ENGINE) == level(PAD) == 0
    sound.handle_event(ADDED)  # a device that comes is no reason to begin
    steps(sound, 10, engine=1.0)
    assert level(ENGINE) == 0
    sound.handle_event(GAINED)
    steps(sound, 30, engine=1.0)
    assert level(ENGINE) > 0.9
    assert level(PAD) > 0


def test_a_device_that_goes_leaves_the_game_on_the_next_one(sound: Sound):
    steps(sound, 30, engine=1.0)
    sound.handle_event(pygame.event.Event(pygame.AUDIODEVICEREMOVED, which=2, iscapture=1))  # a microphone
    assert level(ENGINE) > 0.9
    sound.play("bell")
    sound.handle_event(REMOVED)
    assert sound.ready
    steps(sound, 30, engine=1.0)
    assert level(ENGINE) > 0.9


def test_the_last_device_that_goes_leaves_silence_until_one_comes(sound: Any, monkeypatch):
    monkeypatch.setenv("SDL_AUDIODRIVER", "nonesuch")
    sound.handle_event(REMOVED)
    assert not sound.ready
    assert "nonesuch" in sound.problem
    sound.play("bell")
    steps(sound, 5, engine=1.0)
    monkeypatch.setenv("SDL_AUDIODRIVER", "dummy")
    sound.handle_event(ADDED)
    assert sound.ready
    assert not sound.problem
    steps(sound, 30, engine=1.0)
    assert level(ENGINE) > 0.9


def test_a_mixer_that_fails_meanwhile_is_let_go(sound: Sound):
    steps(sound, 5, engine=1.0)
    pygame.mixer.quit()
    steps(sound, 5, engine=1.0)
    sound.play("bell")
    assert not sound.ready
    assert sound.problem


def test_sound_that_was_never_opened_is_silent_and_looks_for_no_device():
    sound = Sound(INSTRUMENTS)
    sound.handle_event(GAINED)
    sound.play("bell")
    steps(sound, 3, engine=1.0)
    assert pygame.mixer.get_init() is None
    sound.close()


def test_closing_leaves_neither_device_nor_thread():
    sound = Sound()  # the game's own sounds, which take a while
    sound.open()
    sound.play("choose")  # not ready yet, or just: no error
    sound.close()
    assert pygame.mixer.get_init() is None
    assert not [thread for thread in threading.enumerate() if thread.name == "sounds"]
    sound.handle_event(GAINED)
    assert not sound.ready
