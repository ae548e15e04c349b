"""Game window: opening, full screen, size and frame rate."""

from __future__ import annotations

import os
from typing import Final

import pygame

from game.core import texts
from game.drawing.tokens import DUSK, HUMAN, INK, MUTE, NIGHT1, VIEW_SIZE

MINIMUM_SIZE: Final = (640, 360)
_INVISIBLE: Final = ("offscreen", "dummy", "evdev")  # SDL's drivers without a screen
# Of the icon, in pixels of a large one.
_ICON: Final = 256
_ICON_SHOWN: Final = 64
_STAGE: Final = [(84, 128), (172, 128), (180, 152), (164, 168), (92, 168), (76, 152)]
_CABIN: Final = [(100, 84), (120, 68), (148, 68), (164, 88), (164, 122), (92, 122)]
_LEGS: Final = [((84, 150), (60, 198)), ((172, 150), (196, 198)), ((48, 198), (74, 198)), ((182, 198), (208, 198))]


class NoDisplayError(Exception):
    """Error: there is no screen to open a window on."""


class GameWindow:
    """Resizable window, which is not recreated when full screen changes.

    Attributes:
        minimised: whether the window is minimised, so that nothing drawn is visible.

    Raises:
        NoDisplayError: no window can be opened.

    """

    def __init__(self, full_screen: bool) -> None:
        try:
            pygame.display.init()
            if "SDL_VIDEODRIVER" not in os.environ and not _is_seen():
                raise pygame.error(texts.NO_VIDEO_DEVICE)
            pygame.font.init()
            desktop = pygame.display.get_desktop_sizes()[0]
            windowed = fitting(desktop) if _is_seen() else VIEW_SIZE
            size = desktop if full_screen else windowed  # see `_place`
            self._window = pygame.Window(texts.GAME, size, resizable=True, fullscreen_desktop=full_screen)
            self._window.get_surface()
        except pygame.error as error:
            raise NoDisplayError(str(error)) from error
        self._window.minimum_size = MINIMUM_SIZE
        self._window.set_icon(draw_icon())
        self._full_screen = full_screen
        self._windowed: tuple[tuple[int, int], tuple[int, int] | int] = (windowed, pygame.WINDOWPOS_CENTERED)
        self.minimised = False

    @property
    def surface(self) -> pygame.Surface:
        """Surface of the window's pixels; a new one after every change of size."""
        return self._window.get_surface()

    @property
    def size(self) -> tuple[int, int]:
        """Size of the window in pixels."""
        return self._window.size

    @size.setter
    def size(self, size: tuple[int, int]) -> None:
        self._window.size = size

    def stay_legible(self) -> None:
        """Ask for the least size at which text can be read, where a window manager has made the window smaller."""
        width, height = self.size
        least = max(width, MINIMUM_SIZE[0]), max(height, MINIMUM_SIZE[1])
        if least != (width, height) and not self._full_screen:
            self.size = least

    @property
    def position(self) -> tuple[int, int]:
        """Position of the window's top left corner on the desktop, in pixels."""
        return self._window.position

    @property
    def full_screen(self) -> bool:
        """Whether the window covers the whole desktop; can be set."""
        return self._full_screen

    @full_screen.setter
    def full_screen(self, wanted: bool) -> None:
        if wanted == self._full_screen:
            return
        self._full_screen = wanted
        if wanted:
            self._windowed = (self._window.size, self._window.position)
            self._place(pygame.display.get_desktop_sizes()[0], (0, 0))
            self._window.set_fullscreen(True)
        else:
            self._window.set_windowed()
            self._place(*self._windowed)

    def _place(self, size: tuple[int, int], position: tuple[int, int] | int) -> None:
        # A window manager does this by itself. A bare X server has none, and only one screen.
        if len(pygame.display.get_desktop_sizes()) == 1 and self._window.size != size:
            self._window.size = size
            self._window.position = position

    @property
    def frame_rate(self) -> int:
        """Frames per second to draw on this screen; few while the window is not visible."""
        if self.minimised:
            return 20
        rates = pygame.display.get_desktop_refresh_rates()
        return min(max(rates[0] if rates else 60, 60), 144)

    def flip(self) -> None:
        """Show the frame that was drawn."""
        self._window.flip()

    def close(self) -> None:
        """Close the window and release the display."""
        self._window.destroy()
        pygame.display.quit()


def _is_seen() -> bool:
    return pygame.display.get_driver() not in _INVISIBLE


def fitting(desktop: tuple[int, int]) -> tuple[int, int]:
    """Return the size of the first window: the usual one, or as large as a small desktop can show in that shape."""
    (width, height), (wide, high) = VIEW_SIZE, desktop
    share = min(1.0, wide / width, high / height)
    return max(round(share * width), MINIMUM_SIZE[0]), max(round(share * height), MINIMUM_SIZE[1])


def draw_icon(size: int = _ICON_SHOWN) -> pygame.Surface:
    """Return the icon, `size` pixels wide, drawn by code: a lander over the moon's edge."""
    sheet = pygame.Surface((_ICON, _ICON), pygame.SRCALPHA)
    whole = sheet.get_rect()
    mask = sheet.copy()
    pygame.draw.rect(mask, "white", whole, border_radius=56)
    sheet.fill(NIGHT1)
    pygame.draw.circle(sheet, MUTE, (128, 474), 276)
    pygame.draw.circle(sheet, DUSK, (128, 484), 276)
    for start, end in _LEGS:
        pygame.draw.line(sheet, INK, start, end, 9)
    pygame.draw.polygon(sheet, HUMAN, _STAGE)
    pygame.draw.polygon(sheet, INK, _CABIN)
    pygame.draw.polygon(sheet, NIGHT1, [(112, 92), (126, 84), (126, 104), (110, 104)])
    pygame.draw.line(sheet, INK, (140, 68), (140, 44), 5)
    pygame.draw.circle(sheet, HUMAN, (140, 40), 9)
    sheet.blit(mask, (0, 0), special_flags=pygame.BLEND_RGBA_MULT)
    return pygame.transform.smoothscale(sheet, (size, size))
