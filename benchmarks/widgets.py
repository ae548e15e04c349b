"""pygame_gui's widgets beside ours: time, sharpness, keys and gamepad, letters taken. docs/adr/0014 has the figures.

    python -m benchmarks.widgets

SDL draws into memory. Times are CPU milliseconds of one core, the median of several rounds. Both draw the same words
in the same type, Manrope at 15 points, in a view of 1280 x 720 points.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ["SDL_VIDEODRIVER"] = os.environ["SDL_AUDIODRIVER"] = "dummy"

import argparse
import statistics
import time
import warnings
from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pygame
from font_manrope import font_files
from pygame_gui import UIManager
from pygame_gui.elements import UIButton, UILabel, UITextEntryLine, UITooltip

from game.core.settings import Settings
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, TEXT, VIEW_SIZE
from game.ui.context import Context
from game.ui.entry import Entry
from game.ui.form import Form
from game.ui.tooltip import draw_tooltip
from game.ui.widgets import TextButton

ROUNDS: Final = 9
COUNT: Final = 40  # widgets of a full screen
WINDOWS: Final = ((960, 540), (1280, 720), (1920, 1080))
WORDS: Final = "Train a network"
LETTERS: Final = "aéßøŁжλあ日한"


def milliseconds(deed: Callable[[], object], times: int = 20) -> float:
    """Return the median over rounds of the CPU time of one deed."""
    rounds = []
    for _ in range(ROUNDS):
        start = time.process_time()
        for _ in range(times):
            deed()
        rounds.append(1000 * (time.process_time() - start) / times)
    return statistics.median(rounds)


def theirs(size: tuple[int, int], points: float = TEXT) -> UIManager:
    """Return a manager for a window of this size, with Manrope in the whole number of pixels nearest to the points."""
    pixels = max(1, round(points * size[0] / VIEW_SIZE[0]))
    font = {"name": "manrope", "size": str(pixels), "regular_path": font_files["Manrope"]}
    colours = {"normal_text": "#{:02x}{:02x}{:02x}".format(*INK), "dark_bg": "#000000"}
    looks = {kind: {"font": font, "colours": colours} for kind in ("button", "label", "text_entry_line", "tool_tip")}
    return UIManager(size, looks, enable_live_theme_updates=False)


def places(scale: float) -> list[pygame.Rect]:
    """Return the boxes of the widgets in pixels, in four columns."""
    return [
        pygame.Rect(*(round(scale * side) for side in (60 + 290 * (number % 4), 60 + 60 * (number // 4), 200, 32)))
        for number in range(COUNT)
    ]


def redrawn() -> None:
    """Print the time of a frame that nothing happens in, of a new window size, and of building a screen."""
    print(f"{COUNT} buttons        still frame    all words change    another window size        screen is built")
    for size in WINDOWS:
        window, scale = pygame.Surface(size), size[0] / VIEW_SIZE[0]
        manager = theirs(size)
        for kind in (UIButton, UILabel):
            ticks = count(1)
            made: list[Any] = [kind(box, f"{WORDS} {number}", manager) for number, box in enumerate(places(scale))]

            def still(manager: UIManager = manager, window: pygame.Surface = window) -> None:
                manager.update(1 / 60)
                manager.draw_ui(window)

            def changed(
                made: list[Any] = made, still: Callable[[], None] = still, ticks: Iterator[int] = ticks
            ) -> None:
                for number, each in enumerate(made):
                    each.set_text(f"{WORDS} {number + next(ticks)}")
                still()

            def build(size: tuple[int, int] = size, scale: float = scale, kind: Any = kind) -> None:
                other = theirs(size)
                for number, box in enumerate(places(scale)):
                    kind(box, f"{WORDS} {number}", other)

            still()
            anew = milliseconds(build, 1)  # for another size of the window too: font sizes are part of the theme
            print(
                f"  {size[0]:>4}, {kind.__name__:<9} {milliseconds(still):8.2f} {milliseconds(changed, 3):18.2f}"
                f" {anew:22.2f} {anew:22.2f}"
            )
            for each in made:
                each.kill()
        ours(window)


def ours(window: pygame.Surface) -> None:
    """Print the same of our buttons."""
    with TemporaryDirectory() as folder:
        context = Context(Path(folder), Settings())
        form, canvas = Form(context), Canvas(window)
        made = [
            form.add(TextButton(form.manager, box, f"{WORDS} {n}", lambda: None)) for n, box in enumerate(places(1))
        ]

        def still() -> None:
            form.manager.update(1 / 60)
            form.draw(canvas)

        def changed() -> None:
            for number, each in enumerate(made):
                each.label = f"{WORDS} {number + next(ticks)}"
            still()

        def resized() -> None:
            typeface.forget()
            still()

        def build() -> None:
            other = Form(context)
            for number, box in enumerate(places(1)):
                other.add(TextButton(other.manager, box, f"{WORDS} {number}", lambda: None))

        still()
        ticks = count(1)
        print(
            f"  {window.width:>4}, {'ours':<9} {milliseconds(still):8.2f} {milliseconds(changed, 3):18.2f}"
            f" {milliseconds(resized, 3):22.2f} {milliseconds(build, 1):22.2f}"
        )


def ink(surface: pygame.Surface) -> npt.NDArray[np.float64]:
    """Return the coverage of each pixel, 0 to 1, of light words on black."""
    return np.asarray(pygame.surfarray.array3d(surface).max(axis=2) / max(INK))


def sharp() -> None:
    """Print how wide the words are in points, and which share of their pixels is grey: between 15% and 85% covered."""
    print("\nwords in 15 points         width in points     grey pixels")
    for size in WINDOWS:
        scale = size[0] / VIEW_SIZE[0]
        window = pygame.Surface(size)
        Canvas(window).text(WORDS, (100, 100), size=TEXT, colour=INK)
        rebuilt = _label(theirs(size), size, scale)
        stretched = pygame.transform.smoothscale(_label(theirs(VIEW_SIZE), VIEW_SIZE, 1.0), size)
        for name, picture in (("ours", window), ("rebuilt for the window", rebuilt), ("stretched", stretched)):
            cover = ink(picture)
            columns = np.flatnonzero(cover.max(axis=1) > 0.15)
            wide = (columns[-1] - columns[0] + 1) / scale
            grey = ((cover > 0.15) & (cover < 0.85)).sum() / (cover > 0.15).sum()
            print(f"  {size[0]:>4}, {name:<24} {wide:8.1f} {100 * grey:16.0f} %")


def _label(manager: UIManager, size: tuple[int, int], scale: float) -> pygame.Surface:
    window = pygame.Surface(size)
    box = pygame.Rect(*(round(side * scale) for side in (100, 80, 300, 32)))
    UILabel(box, WORDS, manager)
    manager.update(1 / 60)
    manager.draw_ui(window)
    return window


def steered() -> None:
    """Print how many of three buttons the focus comes to, by Tab, by arrows and by a gamepad."""
    keys = {
        "Tab": pygame.Event(pygame.KEYDOWN, key=pygame.K_TAB, mod=0, unicode="\t"),
        "arrow": pygame.Event(pygame.KEYDOWN, key=pygame.K_DOWN, mod=0, unicode=""),
        "gamepad": pygame.Event(pygame.CONTROLLERBUTTONDOWN, button=pygame.CONTROLLER_BUTTON_DPAD_DOWN, instance_id=0),
    }
    print("\nof 3 buttons, in focus     pygame_gui     ours")
    for name, event in keys.items():
        manager = theirs(VIEW_SIZE)
        buttons = [UIButton(pygame.Rect(60, 60 + 60 * n, 200, 32), WORDS, manager) for n in range(3)]
        manager.set_focus_set(buttons[0])
        with TemporaryDirectory() as folder:
            form = Form(Context(Path(folder), Settings()))
            for n in range(3):
                form.add(TextButton(form.manager, (60, 60 + 60 * n, 200, 32), WORDS, lambda: None))
            seen, own = set(), set()
            for _ in range(6):
                manager.process_events(event)
                form.handle_event(event)
                seen |= {number for number, button in enumerate(buttons) if button.is_focused}
                own.add(form.focused)
        print(f"  {name:<20} {len(seen):12} {len(own):12}")


def written() -> None:
    """Print the time that a typed letter takes, and which letters of several scripts are taken."""
    manager = theirs(VIEW_SIZE)
    line = UITextEntryLine(pygame.Rect(60, 60, 400, 32), manager)
    manager.set_focus_set(line)
    with TemporaryDirectory() as folder:
        form = Form(Context(Path(folder), Settings()))
        entry = form.add(Entry(form.manager, (60, 60, 400, 32), "", "", lambda _: None, limit=10**6))
        entry.begin()
        form.update()
        both: list[tuple[str, Callable[[pygame.Event], object], Callable[[], str]]] = [
            ("UITextEntryLine", manager.process_events, lambda: line.text),
            ("ours", form.handle_event, lambda: entry.text),
        ]
        for name, take, read in both:
            for letter in LETTERS:
                take(pygame.Event(pygame.TEXTINPUT, text=letter))
            taken = read()

            def type_and_erase(take: Callable[[pygame.Event], object] = take) -> None:
                take(pygame.Event(pygame.TEXTINPUT, text="a"))
                take(pygame.Event(pygame.KEYDOWN, key=pygame.K_BACKSPACE, mod=0, unicode=""))

            print(
                f"\n{name}: {milliseconds(type_and_erase, 10):.3f} ms for a letter and Backspace; of {LETTERS}: {taken}"
            )


def tooltips() -> None:
    """Print the time of showing a tooltip of two lines at another place."""
    manager, window = theirs(VIEW_SIZE), pygame.Surface(VIEW_SIZE)
    canvas = Canvas(window)

    def shown() -> None:
        tip = UITooltip("Epsilon<br>0.05", (0, 10), manager)
        tip.find_valid_position(pygame.Vector2(300, 300))
        manager.draw_ui(window)
        tip.kill()

    own = milliseconds(lambda: draw_tooltip(canvas, (300, 300), (0, 0, *VIEW_SIZE), ["Epsilon", "0.05"]))
    print(f"\na tooltip: UITooltip {milliseconds(shown, 3):.2f} ms, ours {own:.2f} ms")


def main() -> None:
    """Print everything."""
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    warnings.simplefilter("ignore")  # pygame_gui's, on fonts that are loaded when they are needed
    pygame.init()
    pygame.display.set_mode(VIEW_SIZE)
    redrawn()
    sharp()
    steered()
    written()
    tooltips()


if __name__ == "__main__":
    main()
