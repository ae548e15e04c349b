"""Read-outs of a flight on the ground line, and the words in the corners of what flies."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Final

import numpy as np
import pygame

from ai.lander.environment import Cause, LanderEnv, Outcome
from ai.lander.rules import tenths
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.cursor import BASELINE, LEADING, Cursor
from game.drawing.shapes import Shape
from game.drawing.tokens import FIGURE, INK, LABEL, MARGIN, MUTE, NIGHT0, SMALL, STEP, Colour
from game.flight import outcomes

Lamp = tuple[Shape, Colour, float]  # shape, colour and strength of the glow

LITTLE_TIME: Final = 5.0  # seconds left, below which a pilot is warned
LITTLE_FUEL: Final = 0.2  # share of the tank left, likewise
_PITCH: Final = 124.0  # points from one read-out to the next, and at least
_NARROW: Final = 88.0
_LABEL_LINE, _FIGURE_LINE = 12.0, 46.0  # baselines, in points below the top of a read-out
_BAR_LINE: Final = 57.0
_HEIGHT: Final = 64.0
_BAR: Final = (92.0, 2.0)
_SMALLER: Final = 26.0  # size of a figure that has little room
_SHADE: Final = 0.8  # greatest darkness behind the read-outs
_SIDES: Final = 0.05  # of a view's width, left free at either side
_CAPITAL: Final = 0.72  # height of a figure, in shares of its font size
_PLENTY_OF_TIME: Final = 120.0
_STILL: Final = 0.05  # m/s, and half a degree, below which a figure has no direction
_LEAN: Final = 0.5


@dataclass(frozen=True)
class Readout:
    """One read-out on the ground line: a figure with its label and bar.

    Attributes:
        fill: filled share of the bar, 0 to 1; None for no bar.
        limit: place of the limit's tick on the bar, 0 to 1; None for no limit.
        within: whether the value is within the limit; None without a limit.
        towards: the side to which it goes or leans: -1 left, 1 right, 0 neither.
        what: what it is, for whoever asks.

    """

    label: str
    figure: str
    unit: str
    fill: float | None = None
    limit: float | None = None
    within: bool | None = None
    towards: int = 0
    what: str = ""


def _altitude(env: LanderEnv, slot: int) -> Readout:
    altitude = max(0.0, float(env.altitude[slot]))
    return Readout(texts.ALTITUDE, f"{altitude:.1f}", "m", what=texts.EXPLAIN_READOUTS["altitude"])


def _descent(env: LanderEnv, slot: int) -> Readout:
    descent = 0.0 - float(env.velocity[slot, 1])  # no minus before 0
    return _limited("descent", texts.DESCENT, descent if abs(descent) >= _STILL else 0.0, env.limits.touch_speed)


def _drift(env: LanderEnv, slot: int) -> Readout:
    across = float(env.velocity[slot, 0])
    if env.conditions.moves:  # on a moving pad, the speed relative to the pad counts
        across -= float(env.pad_velocity[slot])
    towards = 0 if abs(across) < _STILL else 1 if across > 0 else -1
    return _limited("drift", texts.DRIFT, abs(across), env.limits.slide_speed, towards=towards)


def _tilt(env: LanderEnv, slot: int) -> Readout:
    tilt = math.degrees(float(env.tilt[slot]))
    towards = 0 if tilt < _LEAN else -1 if math.sin(float(env.angle[slot])) > 0 else 1
    return _limited("tilt", texts.TILT, tilt, math.degrees(env.limits.touch_tilt), towards=towards, unit="°")


def _limited(name: str, label: str, value: float, limit: float, *, towards: int = 0, unit: str = "m/s") -> Readout:
    """Return a read-out of what a touchdown limits."""
    figure, reach = f"{value:.0f}" if unit == "°" else f"{value:.1f}".replace("-", "−"), max(0.0, value)
    what = texts.EXPLAIN_READOUTS[name].format(limit=f"{limit:.0f}°" if unit == "°" else f"{limit:.1f} {unit}")
    return Readout(label, figure, unit, reach / (1.8 * limit), 1 / 1.8, reach <= limit, towards, what)


def _thrust(env: LanderEnv, slot: int) -> Readout:
    share = float(env.thrust[slot, 0])
    return Readout(texts.THRUST, f"{100 * share:.0f}", "%", share)


def _fuel(env: LanderEnv, slot: int) -> Readout:
    """Return the read-out of the fuel used, or, where the tank is limited, of the fuel left."""
    burnt, tank = tenths(float(env.fuel[slot])), env.conditions.tank  # rounded as on the card and for medals
    what = texts.EXPLAIN_READOUTS["fuel"]
    if tank == math.inf:
        return Readout(texts.FUEL_USED, f"{burnt:.1f}", "s", what=what)
    left = max(0.0, tank - burnt)
    within = None if left > LITTLE_FUEL * tank else False
    return Readout(texts.FUEL_LEFT, f"{left:.1f}", "s", left / tank, within=within, what=what)


def _time(env: LanderEnv, slot: int) -> Readout:
    """Return the read-out of the time left, or, where there is plenty, of the time flown."""
    flown, limit = float(env.time[slot]), env.limits.time
    if limit > _PLENTY_OF_TIME:
        return Readout(texts.TIME_FLOWN, f"{flown:.0f}", "s")
    left = max(0.0, limit - flown)
    return Readout(texts.TIME_LEFT, f"{left:.0f}", "s", left / limit, within=None if left > LITTLE_TIME else False)


GAUGES: Final[dict[str, Callable[[LanderEnv, int], Readout]]] = {
    "altitude": _altitude, "descent": _descent, "drift": _drift, "tilt": _tilt, "thrust": _thrust, "fuel": _fuel,
    "time": _time,
}  # fmt: skip
# What a pilot needs all the time stands on the left, the rest on the right: the landing pad stands in the middle.
PILOT: Final = ("altitude", "descent", "drift", "tilt")
_SPEEDS: Final = ("descent", "drift")
# The read-out that names a crash, and which of an impact's figures that has.
FELT: Final = {Cause.HARD: ("descent", 0), Cause.SLIDING: ("drift", 1), Cause.TILTED: ("tilt", 2)}


def flight_readouts(env: LanderEnv, slot: int = 0) -> dict[str, Readout]:
    """Return the read-outs of a flight, by their names in `GAUGES`."""
    return {name: read(env, slot) for name, read in GAUGES.items()}


def at_touch(readouts: dict[str, Readout], env: LanderEnv) -> dict[str, Readout]:
    """Return the last read-outs before a crash, with the figure marked that the reason of the crash names.

    On level ground it becomes what the foot felt, which a turning craft puts down faster than it falls itself.
    """
    cause = outcomes.cause_of(env)
    if env.outcome[0] != Outcome.CRASHED or cause not in FELT:
        return readouts
    name, number = FELT[cause]
    felt = float(env.impact[0, number])
    figure = f"{math.degrees(felt):.0f}" if cause is Cause.TILTED else f"{felt:.1f}"
    if outcomes.struck_side(env):  # neither down nor across, but the faster of the two is nearer to it
        name = max(("descent", "drift"), key=lambda each: readouts[each].fill or 0.0)
        figure = readouts[name].figure
    elif cause is Cause.TILTED:  # which tells how fast it came down, too
        speed = outcomes.touch_speed(env)
        fell = replace(readouts["descent"], figure=f"{speed:.1f}", within=speed <= env.limits.touch_speed)
        readouts = {**readouts, "descent": fell}
    return {**readouts, name: replace(readouts[name], figure=figure, within=False)}


def at_rest(readouts: dict[str, Readout]) -> dict[str, Readout]:
    """Return the last read-outs of a craft that stands now: nothing falls or drifts any more."""
    still = {name: replace(readouts[name], figure="0.0", fill=0.0, towards=0, within=True) for name in _SPEEDS}
    return {**readouts, **still}


def foot_of(canvas: Canvas, names: Iterable[str]) -> pygame.FRect:
    """Return where a flight's read-outs stand at the foot of its screen, in points."""
    view = canvas.view
    side = min(MARGIN, _SIDES * view.width)
    cursor = Cursor(side, 0.0, view.width - 2 * side)
    _arrange(cursor, tuple(names))
    return pygame.FRect(side, view.bottom - cursor.y - 2 * STEP, cursor.width, cursor.y)


def draw_flight(
    canvas: Canvas, readouts: Mapping[str, Readout], names: Iterable[str] = GAUGES, row: float = 0.0
) -> None:
    """Draw those of a flight's read-outs that are named at the foot of its screen, above a `row` of points there."""
    shown = {name: readouts[name] for name in names if name in readouts}
    foot = foot_of(canvas, shown).move(0, -row)
    draw_shade(canvas, foot.top - STEP)
    write_readouts(Cursor(foot.left, foot.top, foot.width, canvas.scale, canvas), shown)


def write_readouts(cursor: Cursor, shown: Mapping[str, Readout]) -> None:
    """Write read-outs side by side, as a row: what a pilot needs on the left, and the rest at the right end."""
    for name, box in _arrange(cursor, tuple(shown)).items():
        if cursor.canvas:
            _draw_readout(cursor.canvas, box, shown[name])


def _arrange(cursor: Cursor, names: Sequence[str]) -> dict[str, pygame.FRect]:
    """Return where each of these read-outs stands, in points; in two lines where one is too short."""
    pilots, others = [name for name in names if name in PILOT], [name for name in names if name not in PILOT]
    lines = [(pilots, others)] if len(names) * _NARROW <= cursor.width else [(others, []), (pilots, [])]
    places = {}
    for left, right in lines:
        pitch = min(_PITCH, cursor.width / max(1, len(left) + len(right)))
        starts = [cursor.left + number * pitch for number in range(len(left))]
        starts += [cursor.right - pitch * (len(right) - number) for number in range(len(right))]
        for name, start in zip([*left, *right], starts, strict=True):
            places[name] = pygame.FRect(start, cursor.y, min(pitch - STEP, _BAR[0] + 2 * STEP), _HEIGHT)
        cursor.gap(_HEIGHT if starts else 0.0)
    return places


def draw_shade(canvas: Canvas, top: float) -> None:
    """Darken the ground below a place, in points: over craters and wrecks figures stay readable."""
    height = canvas.surface.get_height() - canvas.px(top)
    if height > 0:
        shade = _shade((canvas.surface.get_width(), height))
        canvas.surface.blit(shade, (0, canvas.px(top)), special_flags=pygame.BLEND_PREMULTIPLIED)


def _draw_readout(canvas: Canvas, box: pygame.FRect, readout: Readout) -> None:
    """Draw a read-out: the bar shows the distance from the limit, a mark by the label on which side."""
    x, y, wide = box.left, box.top + _BAR_LINE, min(_BAR[0], box.width)
    colour = INK if readout.within is None else canvas.palette.good if readout.within else canvas.palette.warn
    size = FIGURE if box.width > _BAR[0] else _SMALLER
    top, line = box.top + _LABEL_LINE, box.top + _FIGURE_LINE
    end = canvas.text(readout.label, (x, top), size=LABEL, colour=MUTE, weight="medium").right + 9
    if readout.towards:
        draw_arrow(canvas, (end + 5, top - 4), 16.0 * readout.towards, INK)
        end += 24
    if readout.within:
        canvas.dot((end, top - 4), 2.0, colour, 0.9)
    elif readout.within is not None:
        canvas.marker("triangle", (end, top - 4), 9, colour)
    figure = canvas.text(readout.figure, (x - 1, line), size=size, colour=colour, weight="light", tabular=True)
    gap, rise = (3, _CAPITAL * (size - SMALL)) if readout.unit == "°" else (6, 0.0)
    canvas.text(readout.unit, (figure.right + gap, line - rise), size=SMALL, colour=MUTE)
    if readout.fill is not None:
        canvas.bar((x, y, wide, _BAR[1]), readout.fill, colour)
    if readout.limit is not None:
        canvas.line((x + readout.limit * wide, y - 3), (x + readout.limit * wide, y + 5), INK)
    if readout.what:
        canvas.explain(box.move(-4.0, 0), readout.what)


@lru_cache(maxsize=2)
def _shade(size: tuple[int, int]) -> pygame.Surface:
    """Return the dark gradient behind the figures, premultiplied: over craters and wrecks they stay readable."""
    shade = pygame.Surface(size, pygame.SRCALPHA)
    shade.fill(NIGHT0)
    rise = np.linspace(0.0, 1.0, size[1]) ** 0.7
    pygame.surfarray.pixels_alpha(shade)[:] = np.round(255 * _SHADE * rise).astype(np.uint8)
    return shade.premul_alpha_ip()


def draw_arrow(canvas: Canvas, middle: Point, reach: float, colour: Colour) -> None:
    """Draw a level arrow around its middle, `reach` points long: to the right, or to the left if that is negative."""
    x, y = middle
    tip, side = x + reach / 2, math.copysign(1.0, reach)
    canvas.line((x - reach / 2, y), (tip, y), colour, 1.5)
    for lean in (-3.5, 3.5):
        canvas.line((tip, y), (tip - side * 5, y + lean), colour, 1.5)


def yours(human: float) -> int:
    """Return a player's share of a flight, 0 to 1, in percent: 0 for none at all, and 100 only for all of it."""
    return round(100 * human) if human in (0.0, 1.0) else min(max(round(100 * human), 1), 99)


def rate_colour(canvas: Canvas, percent: float) -> Colour:
    """Return the colour of a success rate; the colour of success only where most attempts succeed."""
    return canvas.palette.good if percent > 50 else INK


def write_landings(cursor: Cursor, landed: int, lost: int) -> None:
    """Write the share of flights that have landed, and both counts; nothing before any has ended."""
    if landed + lost == 0:
        return
    share, top = f"{100 * landed / (landed + lost):.0f}", cursor.y
    cursor.y += LEADING * FIGURE
    if canvas := cursor.canvas:
        colour, place = rate_colour(canvas, float(share)), (cursor.left - 1, top + BASELINE * FIGURE)
        figure = canvas.text(share, place, size=FIGURE, weight="light", tabular=True, colour=colour)
        canvas.text(texts.WATCH_LANDED, (figure.right + 6, place[1]), size=SMALL, colour=MUTE)
    cursor.styled(texts.WATCH_COUNTS.format(landed=landed, lost=lost), SMALL, MUTE, tabular=True)
