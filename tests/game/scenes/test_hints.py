"""Hints tell what is bound: keys that were changed are named, and the old ones are not."""

from collections import Counter

import pygame
import pytest

from ai.lander.missions import FIRST, MISSIONS
from game.drawing import glyphs, typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, VIEW_SIZE
from game.input import signs
from game.input.bindings import KEYBOARD, Bindings, Command, Held
from game.input.controls import Controls, key_name
from game.ui.context import Context
from game.ui.hints import Hint, HintRow
from tests.support.screens import FLOWN, OVER_OTHERS, SCREENS, opened, settle

NEW = {Command.HANDOVER: pygame.K_o, Command.RETRY: pygame.K_j, Command.CHOICES: pygame.K_i, Command.STEP: pygame.K_u,
       Command.NEXT: pygame.K_k, Command.PREVIOUS: pygame.K_l, Command.FULLSCREEN: pygame.K_F9,
       Held.MAIN: pygame.K_f, Held.LEFT: pygame.K_q, Held.RIGHT: pygame.K_e}  # fmt: skip


def keys_told(open_game, context: Context, monkeypatch: pytest.MonkeyPatch, name: str) -> Counter[str]:
    """Open a screen, and count the keys that its hints name."""
    settle(context)
    context.controls = Controls()
    driver = opened(open_game, name)
    told: Counter[str] = Counter()
    text = Canvas.text

    def noted(canvas: Canvas, string: str, position: tuple[float, float], **more) -> pygame.FRect:
        if more.get("colour", INK) == INK and more.get("weight") == "medium":  # as keys are written
            told[string] += 1
        return text(canvas, string, position, **more)

    with monkeypatch.context() as patch:
        patch.setattr(Canvas, "text", noted)
        driver.app.draw()
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
    assert settings.form.widgets[0]._hint.startswith("F9 ")
    driver = opened(open_game, "ChoicesScene")
    help_ = driver.top._rows[driver.top.form.widgets[0]]()
    assert " X" in help_
    assert "+" not in help_


def test_a_hint_is_clicked_where_it_is_written_whether_or_not_it_is_drawn():
    canvas, done = Canvas(pygame.Surface(VIEW_SIZE)), []
    hints = [
        Hint("R", "again", lambda: done.append("again")),
        Hint("Space", "stop", lambda: done.append("stop")),
        Hint("wheel", "turn"),
    ]
    row = HintRow(hints, (100, 100))
    again, stop, turn = row.boxes(canvas)
    assert again.right <= stop.left + 12
    assert row.at(canvas, again.center) is hints[0]
    assert row.at(canvas, stop.center) is hints[1]
    assert row.at(canvas, turn.center) is None  # no press does that
    assert row.at(canvas, (100, 300)) is None
    before = pygame.surfarray.array3d(canvas.surface)
    row.draw(canvas)
    written = (pygame.surfarray.array3d(canvas.surface) != before).any(axis=(1, 2)).nonzero()[0]
    assert again.left <= written.min()
    assert written.max() <= turn.right


@pytest.mark.parametrize("from_right", [False, True])
def test_a_row_without_room_is_written_smaller(from_right: bool):
    canvas = Canvas(pygame.Surface(VIEW_SIZE))
    hints = [Hint("Space", "stop the time"), Hint("Period", "the next decision")]
    wide, narrow = (HintRow(hints, (600, 100), from_right, room=room) for room in (1000, 160))
    assert wide.width(canvas) > narrow.width(canvas)
    assert narrow.width(canvas) == pytest.approx(160, abs=3)
    ends = {row.boxes(canvas)[-1].right - 6 if from_right else row.boxes(canvas)[0].left + 6 for row in (wide, narrow)}
    assert ends == {600}


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
