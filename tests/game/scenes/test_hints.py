"""Hints tell what is bound: keys that were changed are named, and the old ones are not."""

from collections import Counter

import pygame
import pytest

from ai.lander.missions import FIRST, MISSIONS
from game.core.scene import Push
from game.drawing import glyphs, typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, VIEW_SIZE
from game.input import signs
from game.input.bindings import KEYBOARD, Bindings, Command, Held
from game.input.controls import Controls, key_name
from game.play.challenge import FlownMission
from game.scenes.menu import MenuScene
from game.scenes.play import PlayScene
from game.ui.context import Context
from game.ui.hints import draw_hints
from tests.game.scenes.test_walks import OVER_OTHERS, SCREENS

NEW = {Command.HANDOVER: pygame.K_o, Command.RETRY: pygame.K_j, Command.CHOICES: pygame.K_i, Command.STEP: pygame.K_u,
       Command.NEXT: pygame.K_k, Command.PREVIOUS: pygame.K_l, Command.FULLSCREEN: pygame.K_F9,
       Held.MAIN: pygame.K_f, Held.LEFT: pygame.K_q, Held.RIGHT: pygame.K_e}  # fmt: skip
FLOWN = {
    "Play": lambda context: PlayScene(context, 3),
    "mission": lambda context: PlayScene(context, 0, challenge=FlownMission(MISSIONS["fall"])),
}


def keys_told(open_game, context: Context, monkeypatch: pytest.MonkeyPatch, name: str) -> Counter[str]:
    """Open a screen, and count the keys that its hints name."""
    context.settings.tutored, context.settings.reduced_motion = True, True
    context.settings_file.save(context.settings)
    context.controls = Controls()
    if name in OVER_OTHERS:
        driver = open_game(MenuScene)
        driver.app.scenes.apply(Push(OVER_OTHERS[name](driver.top)))
    else:
        driver = open_game({**SCREENS, **FLOWN}[name])
    driver.frames(5)
    told: Counter[str] = Counter()
    text = Canvas.text

    def noted(canvas: Canvas, string: str, position: tuple[float, float], **more) -> pygame.FRect:
        if more.get("colour", INK) == INK and more.get("weight") == "medium":  # as keys are written
            told[string] += 1
        return text(canvas, string, position, **more)

    with monkeypatch.context() as patch:
        patch.setattr(Canvas, "text", noted)
        driver.app._draw()
    driver.app.close()
    return told


@pytest.mark.parametrize("name", [*SCREENS, *FLOWN, *OVER_OTHERS])
def test_every_hint_names_the_players_own_key(open_game, context: Context, monkeypatch, name: str):
    before = keys_told(open_game, context, monkeypatch, name)
    bindings = Bindings(KEYBOARD)
    usual = {key_name(KEYBOARD.standard[meaning][0]): key_name(code) for meaning, code in NEW.items()}
    for meaning, code in NEW.items():
        bindings.bind(meaning, code)
    context.settings.keys = bindings.to_dict()
    after = keys_told(open_game, context, monkeypatch, name)
    arrows = Controls().arrows
    wanted = Counter({usual.get(word, word) if word != arrows else word: count for word, count in before.items()})
    assert after == wanted


def test_sentences_name_the_players_own_keys_too(open_game, context: Context):
    bindings = Bindings(KEYBOARD)
    for meaning, code in {Command.FULLSCREEN: pygame.K_F9, Command.FASTER: pygame.K_x}.items():
        bindings.bind(meaning, code)
    context.settings.keys = bindings.to_dict()
    context.settings_file.save(context.settings)
    settings = open_game(SCREENS["SettingsScene"]).top
    assert settings._form.widgets[0]._hint.startswith("F9 ")
    driver = open_game(MenuScene)
    driver.app.scenes.apply(Push(OVER_OTHERS["ChoicesScene"](driver.top)))
    help_ = driver.top._rows[driver.top._form.widgets[0]]()
    assert " X" in help_
    assert "+" not in help_


def test_a_click_on_a_hint_is_a_press_of_its_key():
    canvas, controls = Canvas(pygame.Surface(VIEW_SIZE)), Controls()
    hints = [(controls.word(Command.RETRY), "again"), (controls.key(pygame.K_SPACE), "stop"), ("wheel", "turn")]
    draw_hints(canvas, hints, (100, 100))
    (first, retry), (second, stop) = canvas.links
    assert (retry.key, retry.command) == (pygame.K_r, Command.RETRY)
    assert (stop.key, stop.command) == (pygame.K_SPACE, None)
    assert first.right <= second.left + 12
    assert canvas.linked(first.center) is retry
    assert canvas.linked((100, 300)) is None


def test_every_sign_is_drawn_and_looks_like_no_other():
    for family in signs.FAMILIES:
        pictures = set()
        for number in signs.SIGNS[family]:
            sign = signs.sign(family, number)
            surface, _ = typeface.render(sign, 20.0, "regular", INK)
            assert surface.get_bounding_rect(1).width > 10
            assert abs(surface.get_width() - typeface.reach(sign, 20.0, "regular")) <= 1
            pictures.add(pygame.image.tobytes(surface, "RGBA"))
        assert len(pictures) == len(signs.SIGNS[family])


def test_signs_stand_in_sentences():
    sign = signs.sign("playstation", pygame.CONTROLLER_BUTTON_A)
    parts = [typeface.reach(part, 15.0, "regular") for part in ("Press ", sign, " to fly")]
    assert typeface.reach(f"Press {sign} to fly", 15.0, "regular") == pytest.approx(sum(parts), abs=1)
    assert sign.isprintable() is False  # nobody can type it


def test_every_mission_has_an_icon_of_its_own():
    names = [FIRST.name, *MISSIONS, "daily"]
    pictures = set()
    for name in names:
        surface, _ = typeface.render(glyphs.icon(name), 20.0, "regular", INK)
        pictures.add(pygame.image.tobytes(surface, "RGBA"))
        assert surface.get_bounding_rect(min_alpha=60).height > 10
    assert len(pictures) == len(names)
