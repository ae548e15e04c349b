"""What holds on every screen, in each of its states: one function each, which leaves the screen as it found it."""

import threading
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import pygame
import pytest

from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import A_FRAME, spread
from game.drawing.tokens import INK, VIEW_SIZE
from game.input.bindings import KEYBOARD, Bindings, Command, Held
from game.input.controls import Controls, key_name
from game.scenes.logbook.replay import ReplayScene
from game.scenes.menus.background import LOADER
from game.scenes.play import scene as play_scene
from game.scenes.play.scene import PlayScene
from game.ui.actions import Action, Table
from game.ui.virtual_pointer import VirtualPointer
from tests.game.tour.stops import Stop
from tests.support.driver import Driver
from tests.support.state import state_of
from tests.support.written import Written, misplaced

SHAPES = [(1290, 430), (640, 1280), (800, 600)]  # three to one, one to two, small


@dataclass
class Visit:
    """One look at a screen in one of its states."""

    stop: Stop
    driver: Driver
    written: Written

    def misplaced(self) -> set[tuple[str, str]]:
        """Draw a frame, and return each text in it that does not fit, and why."""
        page = self.written.turn(self.driver.app.canvas)
        self.driver.app.draw()
        assert page.notes, "nothing is written"
        folder = str(self.driver.app.context.user_dir.parent)  # as long as it happens to be
        wrong = set(misplaced(page, self.driver.app.canvas.view))
        whole = {text for text, _ in wrong if folder in text} | {
            texts.BINDINGS_PRESS_KEY,
            texts.LANDINGS["unknown"],
        }  # which end so
        return {(text, how) for text, how in wrong if how != "is cut short" or text not in whole}


# Texts


def texts_fit_at_the_largest_size(visit: Visit) -> None:
    """As a screen opens here; on a page that is as large as its window, so does each text in any other."""
    if (large := visit.misplaced()) and not visit.stop.state:
        visit.driver.write_in("normal")  # a figure over another on purpose does so at the usual size as well
        large -= visit.misplaced()
    assert not large


def texts_fit_in_windows_of_any_shape(visit: Visit) -> None:
    as_usual = visit.misplaced()
    spread(A_FRAME)  # a rough land will do behind texts
    try:
        for size in SHAPES:
            visit.driver.resize(size)
            wrong = {(text, how) for text, how in visit.misplaced() - as_usual if how != "is cut short"}
            assert not wrong, f"misplaced in a window of {size}"  # a figure over another on purpose is so in all
        visit.driver.resize(VIEW_SIZE)
    finally:
        spread(0)


# Few things to choose from, and few words

MOST_CHOICES, MOST_WORDS = 7, 60


def at_first_sight_there_is_little_to_read_and_to_choose_from(visit: Visit) -> None:
    driver = visit.driver
    widgets = driver.form.widgets if hasattr(driver.top, "form") else []
    widgets = [each for each in widgets if not isinstance(each, VirtualPointer)]  # a picture is looked at
    rows = {widget.box.top for widget in widgets}  # the key and the button of one command are one choice
    assert len(rows) <= MOST_CHOICES, [widget.label for widget in widgets]
    page = visit.written.turn(driver.app.canvas)
    driver.app.draw()
    words = [word for note in page.notes for word in note.text.split() if any(map(str.isalpha, word))]
    assert len(words) <= MOST_WORDS, f"{len(words)} words, not {MOST_WORDS}: leave some out of {' '.join(words)}"


MOST_WORDS_IN_FLIGHT = 25


def in_flight_there_is_one_sentence(visit: Visit) -> None:
    driver = visit.driver
    page = visit.written.turn(driver.app.canvas)
    driver.app.draw()
    words = [word for note in page.notes for word in note.text.split() if any(map(str.isalnum, word))]
    assert not driver.top.waiting
    assert not driver.top.flight.over
    assert len(words) <= MOST_WORDS_IN_FLIGHT, (
        f"{len(words)} words, not {MOST_WORDS_IN_FLIGHT}: leave some out of {' '.join(words)} "
        "(FlownFlight._shown names the read-outs)"
    )


def a_craft_hangs_while_its_window_changes(visit: Visit) -> None:
    visit.driver.post(pygame.WINDOWSIZECHANGED)
    scene = visit.driver.top
    if isinstance(scene, PlayScene) and not scene.flight.over and str(visit.stop) not in FLYING:
        assert scene.waiting  # and no flight ends while others look at it


# Drawing


def changed_by_drawing(driver: Driver) -> set[str]:
    """Draw twice, and return what is not as it was."""
    for thread in threading.enumerate():
        if thread.name == LOADER:
            thread.join()  # what it loads comes at any moment, and is none of the drawing's doing
    ways = set()
    scenes = driver.app.scenes
    before = state_of(scenes)
    for alpha in (0.0, 0.5):
        scenes.draw(driver.app.canvas, alpha)
        after = state_of(scenes)
        # What there is only once was None before, and then a picture, or the other way round.
        differing = {way for way in before.keys() | after.keys() if before.get(way) != after.get(way)}
        ways |= {way for way in differing if {before.get(way), after.get(way)} != {"None", None}}
        before = after
    return ways


def drawing_changes_nothing_but_pixels(visit: Visit) -> None:
    driver, scenes = visit.driver, visit.driver.app.scenes
    driver.frames(20)
    scenes.update()  # and before anybody has drawn what that did
    assert not changed_by_drawing(driver)
    driver.app.canvas.surface.fill((0, 0, 0))
    pictures = []
    for _ in range(2):
        scenes.draw(driver.app.canvas, 0.5)
        pictures.append(pygame.surfarray.array3d(driver.app.canvas.surface))
    assert (pictures[0] == pictures[1]).all(), "a second frame is another picture"


# Hints and actions

NEW: dict[Command | Held, int]
NEW = {Command.HANDOVER: pygame.K_y, Command.RETRY: pygame.K_j, Command.CHOICES: pygame.K_i, Command.STEP: pygame.K_u,
       Command.NEXT: pygame.K_h, Command.PREVIOUS: pygame.K_l, Command.FULLSCREEN: pygame.K_F9,
       Held.MAIN: pygame.K_f, Held.LEFT: pygame.K_x, Held.RIGHT: pygame.K_v}  # fmt: skip


def keys_named(driver: Driver) -> Counter[str]:
    """Draw a frame, and count the keys that its hints name."""
    named: Counter[str] = Counter()
    text = Canvas.text

    def noted(canvas: Canvas, string: str, position: tuple[float, float], **more) -> pygame.FRect:
        if more.get("colour", INK) == INK and more.get("weight") == "medium":  # as keys are written
            named[string] += 1
        return text(canvas, string, position, **more)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Canvas, "text", noted)
        driver.app.draw()
    return named


def hints_name_the_players_own_keys(visit: Visit) -> None:
    keys = visit.driver.app.context.controls.keys
    before = keys_named(visit.driver)
    bindings = Bindings(KEYBOARD)
    usual = {key_name(KEYBOARD.standard[meaning][0]): key_name(code) for meaning, code in NEW.items()}
    for meaning, code in NEW.items():
        bindings.bind(meaning, code)
    keys.follow(bindings.to_dict())
    visit.driver.frames(2)
    after = keys_named(visit.driver)
    keys.follow({})
    actions = [entry for entry in visit.driver.top.actions() if isinstance(entry, Action)]
    fixed = {key_name(entry.key) for entry in actions if not isinstance(entry.key, Command)} | {Controls().arrows}
    wanted = Counter()
    for word, count in before.items():
        wanted[word if word in fixed else usual.get(word, word)] += count
    assert after == wanted


def hints_name_the_keys_of_their_own_actions(visit: Visit) -> None:
    scene, controls = visit.driver.top, visit.driver.app.context.controls
    entries = {entry.hint: entry for entry in scene.actions() if isinstance(entry, Action) and entry.hint}
    rows = scene.hint_rows(visit.driver.app.canvas)
    assert rows
    for hint in (hint for row in rows for hint in row.hints if hint.run):
        assert hint.key == entries[hint.meaning].key_word(controls), hint.meaning


class Recorder:
    """Stands in the table of a scene: notes which entry is run, and does nothing else."""

    def __init__(self, scene: object, patch: pytest.MonkeyPatch) -> None:
        self.ran: list[Command | int] = []
        # A flight has a table for each row of hints.
        for owner, name in ((scene, "actions"), (scene, "_card_actions"), (play_scene, "flight_actions")):
            if table := getattr(owner, name, None):
                patch.setattr(owner, name, partial(self._noting, table))
        patch.setattr(scene, "update", lambda: None)

    def _noting(self, table: Callable[..., Table], *given: object) -> Table:
        return [
            replace(entry, run=partial(self.ran.append, entry.key)) if isinstance(entry, Action) else entry
            for entry in table(*given)
        ]

    def take(self) -> list[Command | int]:
        ran, self.ran = self.ran, []
        return ran


# What the keys of a typing widget, or the application itself, do before the scene's table is asked.
TAKEN = {
    "NetworksScene, naming": {Command.CONFIRM, Command.BACK},
    "BindingsScene, binding": {Command.PAUSE},
    "TasteScene": {Command.BACK},  # by Backspace, which takes an answer back
    "NameDialog": {Command.CONFIRM, Command.BACK},
}


def the_key_the_button_and_the_click_run_the_same_action(visit: Visit) -> None:
    with pytest.MonkeyPatch.context() as patch:
        visit.driver.unseen = True  # what is drawn says nothing of it
        _press_all(visit.stop, visit.driver, Recorder(visit.driver.top, patch))
    visit.driver.unseen, visit.driver.app.context.controls.used_pad = False, None


def _press_all(stop: Stop, driver: Driver, recorder: Recorder) -> None:
    scene, controls = driver.top, driver.app.context.controls
    actions = [entry for entry in scene.actions() if isinstance(entry, Action)]
    assert actions
    for action in actions:
        if action.key is Command.FULLSCREEN or action.key in TAKEN.get(str(stop), ()):  # the application's own
            continue
        codes = controls.keys.codes(action.key) if isinstance(action.key, Command) else [action.key]
        for code in codes:
            if code == pygame.K_TAB and not isinstance(scene, PlayScene | ReplayScene):
                continue  # moves the focus
            driver.key(code)
            assert recorder.take() == [action.key], f"{pygame.key.name(code)} of {action}"
        command = action.gamepad or (action.key if isinstance(action.key, Command) else None)
        for code in controls.buttons.codes(command) if command else ():
            if code < 32:  # the others are axes
                driver.button(code)
                assert recorder.take() == [action.key], f"button {code} of {action}"
    driver.key(pygame.K_F1)
    recorder.take()
    for pad in (False, True):
        controls.used_pad = 0 if pad else None
        bound = {entry.hint: entry for entry in scene.actions() if isinstance(entry, Action) and entry.hint}
        for meaning, place in driver.hints().items():
            driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(place), button=1)
            assert recorder.take() == [bound.pop(meaning).key], f"a click on {meaning}"
        assert not bound or stop.screen in ("DigitsScene", "TrainScene", "DigitTrainingScene")


def the_usual_size_of_text_comes_back(visit: Visit) -> None:
    visit.driver.write_in("normal")
    visit.driver.frames(3)
    assert visit.driver.app.canvas.zoom == 1


CHECKERS: tuple[Callable[[Visit], None], ...] = (
    texts_fit_at_the_largest_size,
    the_usual_size_of_text_comes_back,
    in_flight_there_is_one_sentence,
    a_craft_hangs_while_its_window_changes,
    at_first_sight_there_is_little_to_read_and_to_choose_from,
    drawing_changes_nothing_but_pixels,
    texts_fit_in_windows_of_any_shape,
    hints_name_the_players_own_keys,
    hints_name_the_keys_of_their_own_actions,
    the_key_the_button_and_the_click_run_the_same_action,
)
IN_HAND = {"WatchScene, explained"}  # the lander is held there: keys move it, and hints say so
FLYING = {"Play, flown by the network"}
NOT_AT = {
    hints_name_the_keys_of_their_own_actions: IN_HAND | FLYING,  # where there are none
    the_key_the_button_and_the_click_run_the_same_action: IN_HAND,
}
# Screens in rows and columns, which are laid out anew for every window.
FLOWING = {
    "MenuScene", "FlightsScene", "SettingsScene", "BindingsScene", "QuestionDialog", "NameDialog",
    "sound", "controls", "flights", "PauseScene", "FlightPauseScene, of a flight",
    "MissionsScene", "LogbookScene", "PhysicsScene", "PhysicsStepScene", "TrainScene",
    "DigitTrainingScene",
}  # fmt: skip
IN_FLIGHT = {
    "Play, in flight", "mission, in flight", "descent, in flight", "daily, in flight", "tutorial, in flight",
    "Play, guarded", "Play, flown by the network", "Play, shared",
}  # fmt: skip
ONLY_AT = {
    # Whatever is laid out for a page is laid out alike in every window: the last of these stands for all.
    texts_fit_in_windows_of_any_shape: FLOWING | {
        "WatchScene", "ReplayScene", "Play", "swarm", "mission", "TrainScene", "Play, shared", "Play, thinking",
        "tutorial", "mission, card",
    },
    at_first_sight_there_is_little_to_read_and_to_choose_from: FLOWING
    - {"BindingsScene"}  # which is one table
    | {"Play", "mission", "daily", "descent", "LogbookScene, with much to list", "MissionsScene, with much to list"}
    | {"DigitsScene", "DigitInsideScene", "inside, sums", "inside, dreams"},
    in_flight_there_is_one_sentence: IN_FLIGHT,
}  # fmt: skip


def checkers_at(stop: Stop) -> list[Callable[[Visit], None]]:
    """Return the checkers that look at a stop."""
    at = str(stop)
    return [each for each in CHECKERS if at not in NOT_AT.get(each, ()) and at in ONLY_AT.get(each, (at,))]
