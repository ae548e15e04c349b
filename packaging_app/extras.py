"""What the app has besides its program: icons, its name and version, an entry for the desktop's menu, a first page."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Final

from packaging_app import recipe

_DESKTOP: Final = f"""[Desktop Entry]
Type=Application
Name={recipe.TITLE}
Comment=Land on the moon by hand, by network, or share the stick
Exec="@FOLDER@/{recipe.NAME}"
Icon=@FOLDER@/{recipe.NAME}.png
Categories=Game;Education;
StartupWMClass={recipe.NAME}
Terminal=false
"""
_ADD_TO_MENU: Final = f"""#!/bin/sh
# Put Tranquility into the desktop's menu of this user, as it lies here. Delete the file that is named to undo it.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
menu="${{XDG_DATA_HOME:-$HOME/.local/share}}/applications"
mkdir -p "$menu"
awk -v folder="$here" '{{
    while (at = index($0, "@FOLDER@")) $0 = substr($0, 1, at - 1) folder substr($0, at + 8)
    print
}}' "$here/{recipe.NAME}.desktop" > "$menu/{recipe.NAME}.desktop"
echo "$menu/{recipe.NAME}.desktop"
"""
_README: Final = f"""Tranquility {recipe.version()}

Start {recipe.NAME}{".exe" if sys.platform == "win32" else ""}. Nothing needs to be installed, and no network is used.
In a terminal, it has commands too:

    {recipe.NAME} --help
    {recipe.NAME} train --preset modern --seconds 60 --output runs/mine
    {recipe.NAME} verify FLIGHT.json

Your settings, flights and networks are kept in your own folder of data, never here. Replays are saved as GIF.
LICENSES says what is packed, and under which licence.
"""


def draw_icons(folder: Path) -> None:
    """Write the window's icon as each system wants it."""
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
    import pygame
    from PIL import Image

    from game.shell.window import draw_icon

    folder.mkdir(parents=True, exist_ok=True)
    surface = draw_icon(256)
    image = Image.frombytes("RGBA", surface.get_size(), pygame.image.tobytes(surface, "RGBA"))
    image.save(folder / f"{recipe.NAME}.png")
    if sys.platform == "win32":
        image.save(folder / f"{recipe.NAME}.ico", sizes=[(side, side) for side in (16, 32, 48, 64, 256)])
    if sys.platform == "darwin":
        image.save(folder / f"{recipe.NAME}.icns")


def write_metadata(folder: Path) -> None:
    """Write the name and the version where `--version` looks for them; an editable install's own names its folder."""
    name, version = recipe.distribution(), recipe.version()
    metadata = folder / f"{name.replace('-', '_')}-{version}.dist-info" / "METADATA"
    metadata.parent.mkdir(parents=True)
    text = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
    metadata.write_text(text, encoding="utf-8")


def add_extras(app: Path, made: Path) -> None:
    """Put a first page into the app's folder, and on Linux what a desktop's menu needs."""
    (app / "README.txt").write_text(_README, encoding="utf-8")
    if sys.platform == "linux":
        (app / f"{recipe.NAME}.png").write_bytes((made / f"{recipe.NAME}.png").read_bytes())
        (app / f"{recipe.NAME}.desktop").write_text(_DESKTOP, encoding="utf-8")
        script = app / "add-to-menu.sh"
        script.write_text(_ADD_TO_MENU, encoding="utf-8")
        script.chmod(0o755)
