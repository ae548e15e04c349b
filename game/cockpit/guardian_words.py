"""Words on a guardian: what its dial means."""

from __future__ import annotations

from typing import TYPE_CHECKING

from game.core import texts

if TYPE_CHECKING:
    from ai.copilot.copilot import CoPilot


def dial_words(assist: float, copilot: CoPilot | None) -> str:
    """Say when a guardian at that assist, 0 to 1, steps in; empty for a co-pilot of another kind."""
    from ai.copilot.copilot import Mode, guardian_margin

    if copilot is None or copilot.mode is not Mode.GUARDIAN:
        return ""
    return texts.DIAL_BY_POINTS.format(margin=float(guardian_margin(assist))) if assist else texts.DIAL_NEVER
