import gc
import signal
import weakref
from functools import partial
from itertools import count
from pathlib import Path

import pygame
import pytest

from game.core import texts
from game.core.scene import Pop, Push, Replace, Scene, Transition
from game.core.settings import Settings, SettingsFile
from game.drawing.paint_cache import spread
from game.scenes import scene_of
from game.scenes.menus.settings import SettingsScene
from game.scenes.play.pause import PauseScene
from game.shell.app import LOG_NAME, App, log_to
from game.shell.window import NoDisplayError
from game.start import play
from game.ui.context import Context
from tests.support.driver import Driver


class Probe(Scene):
    """A scene that records what it is given and does as it is asked."""

    def __init__(self) -> None:
        self.events: list[pygame.event.Event] = []
        self.updates = self.draws = self.entered = self.left = 0
        self.alphas: list[float] = []
        self.next: Transition | None = None
        self.fails_in = ""

    def fail(self, where: str) -> None:
        if self.fails_in == where:
            raise ZeroDivisionError("a fault on purpose")

    def enter(self) -> None:
        self.entered += 1
        self.fail("enter")

    def exit(self) -> None:
        self.left += 1
        self.fail("exit")

    def handle_event(self, event: pygame.event.Event):
        self.fail("handle_event")
        self.events.append(event)
        return self.next

    def update(self):
        self.fail("update")
        self.updates += 1

    def draw(self, canvas, alpha: float) -> None:
        self.fail("draw")
        self.draws += 1
        self.alphas.append(alpha)


def test_menu_leads_to_settings_by_mouse_and_by_pad(game: Driver):
    game.click(game.widget(texts.MENU["settings"][0]).box.center)
    assert game.top_name == "SettingsScene"
    game.button(pygame.CONTROLLER_BUTTON_B)
    assert game.top_name == "MenuScene"
    game.axis(pygame.CONTROLLER_AXIS_LEFTY, -30000)  # from Settings up to Learn
    game.axis(pygame.CONTROLLER_AXIS_LEFTY, 0)
    game.button(pygame.CONTROLLER_BUTTON_DPAD_DOWN)
    game.button(pygame.CONTROLLER_BUTTON_A)
    assert game.top_name == "SettingsScene"


def test_escape_in_the_menu_leads_to_quit_which_enter_presses(game: Driver):
    game.keys(pygame.K_ESCAPE, pygame.K_ESCAPE)
    assert not game.key(pygame.K_RETURN)


def test_settings_act_at_once_are_saved_at_once_and_survive(open_game, context: Context):
    game, names = open_game(SettingsScene), ("full_screen", "reduced_motion", "colour_safe", "show_hints")
    usual = game.app.canvas.palette
    for name in names:
        game.press_on(texts.SETTINGS[name][0])
        game.app.settings_writer.wait()
        assert getattr(SettingsFile(context.user_dir).load(), name) is not getattr(Settings(), name)
    assert game.app.canvas.palette != usual
    game.app.close()
    again = open_game()
    for name in names:
        assert getattr(again.app.context.settings, name) is not getattr(Settings(), name)
    assert again.app.window.full_screen == again.app.context.settings.full_screen


def test_a_mouse_at_rest_takes_nothing_from_the_keyboard(open_game, monkeypatch: pytest.MonkeyPatch):
    game = open_game(SettingsScene)
    controls, at = game.app.context.controls, (600, 300)
    game.move(at)
    assert controls.mouse_in_use
    game.key(pygame.K_DOWN)
    game.move(at)  # as the system says when the window below it changes
    assert not controls.mouse_in_use
    left, top = game.app.window.position
    monkeypatch.setattr(type(game.app.window), "position", property(lambda _: (left - 160, top - 90)))
    game.move((760, 390))  # it is the window that went up and left
    assert not controls.mouse_in_use
    game.move((770, 390))
    assert controls.mouse_in_use


def test_sixty_updates_a_second_and_no_spiral(open_game, context: Context):
    probe = Probe()
    app = App(
        context,
        lambda _: probe,
        now=iter([0.0, *(n / 144 for n in range(1, 145)), 100.0, 100.01]).__next__,
        scene_of=scene_of,
        capped=False,
    )
    for _ in range(144):
        app.tick()
    assert probe.updates == 60
    assert all(0 <= alpha <= 1 for alpha in probe.alphas)
    app.tick()
    assert probe.updates == 65
    app.tick()
    assert probe.updates <= 66
    app.close()


@pytest.mark.parametrize("where", ["handle_event", "update", "draw", "enter"])
def test_a_scene_that_fails_leaves_the_game_running(game: Driver, context: Context, where: str):
    log_to(context.user_dir)
    broken = Probe()
    broken.fails_in = where
    game.app.show(lambda _: broken)
    if where == "enter":
        game.app.show(lambda context: PauseScene(context, broken))
        game.key(pygame.K_ESCAPE)
    game.key(pygame.K_x)
    game.frames(2)
    assert game.top_name == "ErrorScene"
    assert "a fault on purpose" in (context.user_dir / LOG_NAME).read_text()
    game.key(pygame.K_RETURN)
    assert game.top_name == "MenuScene"
    assert game.frames(2)


class Holder(Probe):
    """Holds something that it gives back."""

    closed = 0

    def close(self) -> None:
        self.closed += 1


def unbuildable(_: Context) -> Probe:
    raise ZeroDivisionError("a fault on purpose")


@pytest.mark.parametrize("way", ["first", "over another"])
def test_a_scene_that_cannot_be_built_is_reported_and_the_others_are_closed(open_game, way: str):
    below = Holder()
    game = open_game(unbuildable if way == "first" else below)
    if way != "first":
        game.app.show(unbuildable)
        assert below.left == 0  # it did not even learn that another was to come
    game.frames(2)
    assert game.top_name == "ErrorScene"
    assert below.closed == (way != "first")
    game.key(pygame.K_RETURN)
    assert game.top_name == "MenuScene"


def test_closing_the_window_closes_every_scene_whatever_fails(open_game):
    held = [Holder(), Holder(), Holder()]
    game = open_game(held[0])
    for scene in held[1:]:
        game.app.scenes.apply(Push(scene))
    held[1].close = partial(held[1].fail, "close")
    held[1].fails_in = "close"
    held[2].fails_in = "exit"
    game.app.close()
    assert [scene.closed for scene in held] == [1, 0, 1]


def test_closing_the_window_saves_the_settings(open_game, context: Context):
    game = open_game(Probe())
    context.settings.model = "mine"
    pygame.event.post(pygame.event.Event(pygame.QUIT))
    assert game.app.run() == 0
    assert SettingsFile(context.user_dir).load().model == "mine"


def test_pause_stops_the_scene_below_and_resumes_it(open_game):
    probe = Probe()
    game = open_game(probe)
    game.app.scenes.apply(Push(PauseScene(game.app.context, probe)))
    assert probe.left == 1
    updates = probe.updates
    game.frames(5)
    assert (probe.updates, probe.draws) == (updates, 1)
    game.key(pygame.K_ESCAPE)
    assert game.top is probe
    assert probe.entered == 1


def test_pause_offers_retry_settings_and_the_way_out(open_game):
    retried = []
    game = open_game()
    game.app.scenes.apply(Push(probe := Probe()))
    game.app.scenes.apply(Push(PauseScene(game.app.context, probe, lambda: retried.append(True))))
    game.keys(pygame.K_DOWN, pygame.K_DOWN, pygame.K_RETURN)
    assert game.top_name == "SettingsScene"
    game.keys(pygame.K_ESCAPE, pygame.K_UP, pygame.K_SPACE)  # what was chosen stays so
    assert retried == [True]
    assert game.top is probe
    game.app.scenes.apply(Push(PauseScene(game.app.context, probe)))
    game.keys(pygame.K_UP, pygame.K_RETURN)
    assert game.top_name == "MenuScene"


def test_a_scene_that_is_left_for_good_is_in_memory_no_more(game: Driver):
    game.keys(*[pygame.K_DOWN] * 5, pygame.K_RETURN)
    settings = weakref.ref(game.top)
    game.frames(20)
    gc.disable()
    try:
        game.key(pygame.K_ESCAPE)
        assert settings() is None
    finally:
        gc.enable()


def test_minimised_draws_nothing_and_comes_back(open_game):
    probe = Probe()
    game = open_game(probe)
    game.post(pygame.WINDOWMINIMIZED)
    draws = probe.draws
    game.frames(3)
    assert probe.draws == draws
    game.post(pygame.WINDOWRESTORED)
    assert probe.draws > draws


def test_screenshot_is_a_picture_of_the_view(game: Driver, context: Context):
    game.frames(2)
    game.key(pygame.K_F12)
    (path,) = (context.user_dir / "screenshots").iterdir()
    assert pygame.image.load(path).get_size() == (1280, 720)


def test_a_screenshot_on_a_full_disk_is_no_picture_and_says_so(game: Driver, context: Context):
    resource = pytest.importorskip("resource")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (900, limits[1]))
    try:
        game.key(pygame.K_F12)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert "could not be saved" in game.said
    assert not list((context.user_dir / "screenshots").iterdir())


def test_no_display_is_a_clear_error(context: Context, monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "nonesuch")
    pygame.display.quit()
    with pytest.raises(NoDisplayError, match="nonesuch"):
        App(context, scene_of=scene_of)


def test_user_folder_that_cannot_be_written_does_not_stop_the_game(open_game, context: Context, tmp_path: Path):
    context.user_dir = tmp_path / "file" / "inside"
    (tmp_path / "file").write_text("in the way")
    game = open_game(SettingsScene)
    game.press_on(texts.SETTINGS["reduced_motion"][0])
    assert game.app.context.settings.reduced_motion
    assert game.frames(3)


def test_interrupt_reaches_the_caller(game: Driver, monkeypatch):
    monkeypatch.setattr(game.app.scenes, "update", lambda: signal.raise_signal(signal.SIGINT))
    with pytest.raises(KeyboardInterrupt):
        game.app.run()
    assert not pygame.display.get_init()


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="the terminal's hang-up")
def test_a_hang_up_closes_the_game_as_its_button_does(monkeypatch, tmp_path: Path):
    updates = count()  # on a slow machine there are several in a frame, and asking again and again means at once
    monkeypatch.setattr(
        "game.shell.scene_manager.SceneManager.update",
        lambda _: next(updates) or signal.raise_signal(signal.SIGHUP),
    )
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)  # tests may run where it is ignored
    try:
        assert play(tmp_path) == 0
    finally:
        signal.signal(signal.SIGHUP, before)
        gc.unfreeze()
        spread(0)  # or all later tests would paint in pieces
    assert (tmp_path / "settings.json").exists()
    assert not pygame.display.get_init()


def test_the_picture_of_a_scene_gives_way_to_the_next_and_not_where_motion_is_reduced(game: Driver, context: Context):
    def corner() -> tuple[int, ...]:
        return tuple(game.app.canvas.surface.get_at((0, 0)))

    class Plain(Probe):
        def __init__(self, colour: tuple[int, int, int]) -> None:
            super().__init__()
            self.colour = colour

        def draw(self, canvas, alpha: float) -> None:
            canvas.surface.fill(self.colour)

    for still in (False, True):
        context.settings.reduced_motion = still
        game.app.scenes.apply(Replace(Plain((200, 0, 0))))
        game.frames(30)
        game.app.scenes.apply(Replace(Plain((0, 0, 200))))
        seen = []
        for _ in range(20):
            game.frames(1)
            seen.append(corner())
        reds = [red for red, *_ in seen]
        assert reds[-1] == 0
        assert reds == sorted(reds, reverse=True)
        assert (100 < reds[0] < 200) is not still
        assert all(blue == pytest.approx(200 - red, abs=4) for red, _, blue, _ in seen)  # always a mixture of both


@pytest.mark.parametrize("leave", [Replace(Probe()), Pop(2)])
def test_a_scene_that_fails_to_leave_gives_back_what_it_holds_and_settings_are_saved(open_game, context, leave):
    held = [Holder(), Holder()]
    game = open_game(held[0])
    context.settings.model = "mine"
    game.app.show(lambda _: held[1])
    held[1].fails_in = "exit"
    held[1].next = leave
    game.key(pygame.K_x)
    assert not game.app.scenes.running or game.top_name == "ErrorScene"
    game.app.close()
    assert held[1].closed == 1
    assert SettingsFile(context.user_dir).load().model == "mine"
