"""Study as one page of HTML that needs nothing else: its plots are SVG within it, and it runs no code."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from typing import Final

from ai.sweep.metric import Point
from ai.sweep.report import duration
from ai.sweep.results import FinishedTrial
from ai.sweep.space import Dimension, shown_value
from ai.sweep.study import Study

_SHOWN: Final = 300  # curves, and rows of the table; the JSON has all
_WIDE, _HIGH, _LEFT, _FOOT = 420, 190, 46, 26  # of a plot, in pixels
_STYLE: Final = """
:root { color-scheme: dark }
body { background: #090c18; color: #e8ecf4; font: 15px/1.5 system-ui, sans-serif; margin: 48px auto; max-width: 1000px;
       padding: 0 24px }
h1 { font-size: 34px; font-weight: 300; margin: 0 } h2 { font-size: 20px; font-weight: 400; margin: 44px 0 8px }
p, th, figcaption, text { color: #8a95ad } p { max-width: 44em }
figure { display: inline-block; margin: 0 28px 20px 0 } figcaption { font-size: 13px }
svg text { fill: #8a95ad; font-size: 11px } .axis { stroke: #282f46 } .seed { fill: none; stroke: #3a445c }
.best { fill: none; stroke: #70c8ff; stroke-width: 2 } .dot { fill: #8a95ad; fill-opacity: .55 } .bar { fill: #70c8ff }
.mark { fill: #70c8ff } .spread { stroke: #e8ecf4 }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 13px }
th { font-weight: 500; text-align: left } td, th { border-bottom: 1px solid #282f46; padding: 4px 16px 4px 0 }
"""


def page(study: Study) -> str:
    """Return the page."""
    plan, ranked, best = study.plan, study.ranked(), study.best()
    count, spent = len(study.trials), sum(trial.seconds for trial in study.trials.values())
    name = escape(study.folder.name)
    less = "less" if study.metric.mode == "min" else "more"
    intro = (
        f"{count:,} of {plan.trials:,} trials, {len(plan.seeds)} seeds each, of {plan.budget:,} {plan.unit}. Compared"
        f" by {escape(plan.metric)}, the {plan.judge} of the seeds; {less} is better. {duration(spent)} of work in all."
    )
    parts = [f"<h1>{name}</h1><p>{intro}</p>"]
    if best:
        named = ", ".join(f"{key} {escape(shown_value(value))}" for key, value in best.params.items())
        parts.append(f"<p>Best: <b>{escape(study.shown(best.value))}</b>, trial {best.number}, with {named}.</p>")
        parts += [_importance(study), _curves(study, ranked, best), _knobs(study, ranked, best)]
        parts.append(_table(study, ranked))
    else:
        parts.append("<p>No trial has a result yet.</p>")
    body = "\n".join(parts)
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{name}</title>'
        f"<style>{_STYLE}</style></head><body>\n{body}\n</body></html>\n"
    )


def _importance(study: Study) -> str:
    if not study.importance:
        return ""
    lines = [
        f'<text x="250" y="{24 * row + 14}" text-anchor="end">{escape(name)}</text>'
        f'<rect class="bar" x="280" y="{24 * row + 5}" width="{300 * share:.1f}" height="10"/>'
        f'<text x="{290 + 300 * share:.1f}" y="{24 * row + 14}">{share:.0%}</text>'
        for row, (name, share) in enumerate(study.importance.items())
    ]
    return (
        "<h2>Which knobs matter</h2>"
        "<p>Share of each knob in setting the best tenth of the trials apart (PED-ANOVA).</p>"
        f'<svg width="720" height="{24 * len(lines)}">{"".join(lines)}</svg>'
    )


def _curves(study: Study, ranked: list[FinishedTrial], best: FinishedTrial) -> str:
    points = [point for trial in ranked[:_SHOWN] for seed in trial.seeds for point in seed.curve]
    if not points:
        return ""
    returns = study.metric.kind == "return" or any(point.success is None for point in points)

    def height(point: Point) -> float:
        return point.mean_return if returns else point.success or 0.0

    low, high = (min(map(height, points)), max(map(height, points))) if returns else (0.0, 1.0)
    reach = max(1, *(point.at for point in points))

    def line(curve: Iterable[Point], kind: str) -> str:
        path = " ".join(f"{_across(each.at / reach)},{_up(height(each), low, high)}" for each in curve)
        return f'<polyline class="{kind}" points="{path}"/>'

    lines = [line(seed.curve, "seed") for trial in ranked[:_SHOWN] if trial is not best for seed in trial.seeds]
    lines += [line(seed.curve, "best") for seed in best.seeds]
    shown = ("{:.0f}" if max(abs(low), abs(high)) < 1e12 else "{:.3g}") if returns else "{:.0%}"
    axes = _axes("0", f"{reach:,} {study.plan.unit}", shown.format(low), shown.format(high))
    return (
        f"<h2>Learning curves</h2><figure><svg width='{_WIDE}' height='{_HIGH + _FOOT}'>{axes}{''.join(lines)}</svg>"
        f"<figcaption>{'Mean return' if returns else 'Share that ended well'} without random actions, every seed; the"
        " best trial in blue</figcaption></figure>"
    )


def _knobs(study: Study, ranked: list[FinishedTrial], best: FinishedTrial) -> str:
    values = [trial.value or 0.0 for trial in ranked]
    low, high = min(values), max(values)
    figures = []
    for name, dimension in study.plan.dimensions().items():
        dots = []
        for trial in ranked[::-1]:
            x, y = _across(dimension.place(trial.params[name])), _up(trial.value or 0.0, low, high)
            size = 5 if trial is best else 3
            dots.append(f'<circle class="{"mark" if trial is best else "dot"}" cx="{x}" cy="{y}" r="{size}"/>')
        left, right = map(shown_value, _ends(dimension))
        axes = _axes(left, right, study.shown(low), study.shown(high))
        figures.append(
            f"<figure><svg width='{_WIDE}' height='{_HIGH + _FOOT}'>{axes}{''.join(dots)}</svg>"
            f"<figcaption>{escape(name)}{', by factors' if dimension.log else ''}</figcaption></figure>"
        )
    return f"<h2>Knobs against result</h2>{''.join(figures)}"


def _table(study: Study, ranked: list[FinishedTrial]) -> str:
    heads = ["trial", study.plan.metric, "of the seeds", *study.plan.space, "trained", "took"]
    rows = []
    for trial in ranked[:_SHOWN]:
        spread = f"{study.shown(min(trial.values))} to {study.shown(max(trial.values))}" if trial.values else "–"
        cells = [
            str(trial.number), study.shown(trial.value), spread, *map(shown_value, trial.params.values()),
            f"{trial.at:,}{', stopped' if trial.stopped else ''}", duration(trial.seconds),
        ]  # fmt: skip
        rows.append(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in cells)}</tr>")
    head = "".join(f"<th>{escape(each)}</th>" for each in heads)
    return f"<h2>Trials</h2><table><tr>{head}</tr>{''.join(rows)}</table>"


def _ends(dimension: Dimension) -> tuple[object, object]:
    return (dimension.choices[0], dimension.choices[-1]) if dimension.choices else (dimension.low, dimension.high)


def _across(share: float) -> str:
    return f"{_LEFT + share * (_WIDE - _LEFT - 12):.1f}"


def _up(value: float, low: float, high: float) -> str:
    value, low, high = value / 2, low / 2, high / 2  # the difference of two floats may be no float
    return f"{8 + (1 - ((value - low) / (high - low) if high > low else 0.5)) * (_HIGH - 16):.1f}"


def _axes(left: str, right: str, low: str, high: str) -> str:
    """Return the hairlines of a plot and what its ends are."""
    return (
        f'<line class="axis" x1="{_LEFT}" x2="{_LEFT}" y1="0" y2="{_HIGH}"/>'
        f'<line class="axis" x1="{_LEFT}" x2="{_WIDE}" y1="{_HIGH}" y2="{_HIGH}"/>'
        f'<text x="{_LEFT}" y="{_HIGH + 16}">{escape(left)}</text>'
        f'<text x="{_WIDE}" y="{_HIGH + 16}" text-anchor="end">{escape(right)}</text>'
        f'<text x="{_LEFT - 4}" y="{_HIGH}" text-anchor="end">{escape(low)}</text>'
        f'<text x="{_LEFT - 4}" y="12" text-anchor="end">{escape(high)}</text>'
    )
