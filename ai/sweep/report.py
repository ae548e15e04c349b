"""What a study tells: as a table, as JSON, and as one page of HTML that needs nothing else and runs no code."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict
from html import escape
from typing import Any, Final

from ai.files import brief
from ai.sweep.metric import Point
from ai.sweep.space import shown_value
from ai.sweep.study import FinishedTrial, Study

_BEST: Final = 10  # rows of the table
_SHOWN: Final = 300  # curves and rows of the page; the JSON has all
_WIDE, _HIGH, _LEFT, _FOOT = 420, 190, 60, 26  # of a plot, in pixels
_STYLE: Final = """
:root { color-scheme: dark }
body { background: #090c18; color: #e8ecf4; font: 15px/1.5 system-ui, sans-serif; margin: 48px auto; max-width: 1000px;
       padding: 0 24px }
h1 { font-size: 34px; font-weight: 300; margin: 0 } h2 { font-size: 20px; font-weight: 400; margin: 44px 0 8px }
p, th, figcaption, text { color: #8a95ad } pre { overflow-x: auto }
figure { display: inline-block; margin: 0 28px 20px 0 } figcaption { font-size: 13px }
svg text { fill: #8a95ad; font-size: 11px } .axis { stroke: #282f46 } .seed { fill: none; stroke: #3a445c }
.best { fill: none; stroke: #70c8ff; stroke-width: 2 } .dot { fill: #8a95ad; fill-opacity: .55 }
.mark { fill: #70c8ff }
"""


def report(study: Study) -> dict[str, Any]:
    """Return all that a study tells, as JSON can hold it."""
    best = study.best()
    return {
        "study": study.folder.name,
        "plan": asdict(study.plan),
        "finished": len(study.trials),
        "damaged": study.damaged,
        "best": best.number if best else None,
        "importance": study.importance,
        "ranking": [trial.number for trial in study.ranked()],
        "trials": [asdict(trial) for _, trial in sorted(study.trials.items())],
    }


def told(study: Study, most: int = _BEST) -> str:
    """Return what a study tells as a table of text, with at most so many trials."""
    plan, best, ranked = study.plan, study.best(), study.ranked()
    trials = f"{study.folder.name}: {len(study.trials)} of {plan.trials} trials, {len(plan.seeds)} seeds each"
    better = f"({'less' if study.metric.sign == 1 else 'more'} is better)"
    lines = [f"{trials}, compared by {plan.metric}, {plan.judge} of the seeds {better}"]
    if study.damaged:
        lines.append(f"of {len(study.damaged)} more, the files cannot be read: {', '.join(map(str, study.damaged))}")
    if senseless := [trial for _, trial in sorted(study.trials.items()) if trial.problem]:
        numbers = ", ".join(str(trial.number) for trial in senseless)
        lines.append(f"of {len(senseless)}, the settings make no sense: {numbers}: {brief(senseless[0].problem)}")
    if not best:
        return "\n".join([*lines, "no trial has a result yet"])
    ranked = [best, *(trial for trial in ranked if trial is not best)]  # a population's is one of its last generation
    lines.append(f"\n{'trial':>5} {plan.metric:>12} {'of the seeds':>24}  settings")
    for trial in ranked[:most]:
        spread = f"{study.shown(min(trial.values))} to {study.shown(max(trial.values))}"
        ended = f", stopped after {trial.at:,} {plan.unit}" if trial.stopped else ""
        lines.append(f"{trial.number:>5} {study.shown(trial.value):>12} {spread:>24}  {settings(trial.params)}{ended}")
    if study.importance:
        lines.append("\nshare of each knob in setting the best trials apart (PED-ANOVA)")
        lines += [f"  {name:24} {share:5.0%}" for name, share in study.importance.items()]
    if folder := study.best_run(best):
        lines.append(f"\nbest network: {folder}")
    return "\n".join(lines)


def settings(params: dict[str, Any]) -> str:
    """Return the settings of a trial in one line."""
    return " ".join(f"{name}={shown_value(value)}" for name, value in params.items())


def page(study: Study) -> str:
    """Return the page: the table, the learning curves, and each knob against the result."""
    ranked, name = study.ranked()[:_SHOWN], escape(study.folder.name)
    plots = [_curves(study, ranked), *(_knob(study, ranked, each) for each in study.plan.space)] if ranked else []
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{name}</title>'
        f"<style>{_STYLE}</style></head><body>\n<h1>{name}</h1>\n{''.join(plots)}\n"
        f"<pre>{escape(told(study, _SHOWN))}</pre>\n</body></html>\n"
    )


def _curves(study: Study, ranked: Sequence[FinishedTrial]) -> str:
    """Return the learning curves of all seeds, those of the best trial last, above the others."""
    points = [point for trial in ranked for seed in trial.seeds for point in seed.curve]
    returns = study.metric.kind == "return" or any(point.success is None for point in points)

    def height(point: Point) -> float:
        return point.mean_return if returns else point.success or 0.0

    heights, reach, best = [*map(height, points)], max([1, *(point.at for point in points)]), study.best()
    low, high = (min(heights, default=0.0), max(heights, default=1.0)) if returns else (0.0, 1.0)
    lines = []
    for trial in sorted(ranked, key=lambda trial: trial is best):
        for seed in trial.seeds:
            path = " ".join(_place(each.at / reach, height(each), low, high) for each in seed.curve)
            lines.append(f'<polyline class="{"best" if trial is best else "seed"}" points="{path}"/>')
    ends = (_figure(low), _figure(high)) if returns else ("0%", "100%")
    what = "Mean return" if returns else "Share that ended well"
    caption = f"{what} without random actions, every seed; the best trial in blue"
    return _plot(lines, ("0", f"{reach:,} {study.plan.unit}"), ends, caption)


def _knob(study: Study, ranked: Sequence[FinishedTrial], name: str) -> str:
    """Return a dot for each trial: its value of a knob against its result."""
    values, dimension, best = [trial.value or 0.0 for trial in ranked], study.plan.space[name], study.best()
    low, high, dots = min(values), max(values), []
    for trial, value in zip(ranked, values, strict=True):
        x, y = _place(dimension.place(trial.params[name]), value, low, high).split(",")
        dots.append(f'<circle class="{"mark" if trial is best else "dot"}" cx="{x}" cy="{y}" r="4"/>')
    left, right = map(shown_value, dimension.ends)
    caption = f"{name}{', by factors' if dimension.log else ''}"
    return _plot(dots[::-1], (left, right), (study.shown(low), study.shown(high)), caption)


def _plot(marks: Iterable[str], across: tuple[str, str], up: tuple[str, str], caption: str) -> str:
    """Return a figure with marks, what its ends are, and a caption."""
    texts = [
        (_LEFT, _HIGH + 16, "start", across[0]), (_WIDE, _HIGH + 16, "end", across[1]),
        (_LEFT - 4, _HIGH, "end", up[0]), (_LEFT - 4, 12, "end", up[1]),
    ]  # fmt: skip
    return (
        f'<figure><svg width="{_WIDE}" height="{_HIGH + _FOOT}">'
        f'<path class="axis" fill="none" d="M{_LEFT},0 V{_HIGH} H{_WIDE}"/>'
        + "".join(f'<text x="{x}" y="{y}" text-anchor="{end}">{escape(text)}</text>' for x, y, end, text in texts)
        + f"{''.join(marks)}</svg><figcaption>{escape(caption)}</figcaption></figure>\n"
    )


def _place(share: float, value: float, low: float, high: float) -> str:
    """Return where a point lies on a plot, as SVG writes it."""
    value, low, high = value / 2, low / 2, high / 2  # the difference of two floats may be no float
    up = (value - low) / (high - low) if high > low else 0.5
    return f"{_LEFT + share * (_WIDE - _LEFT - 12):.1f},{8 + (1 - up) * (_HIGH - 16):.1f}"


def _figure(value: float) -> str:
    return f"{value:.3g}" if abs(value) >= 1e12 else f"{value:.0f}"
