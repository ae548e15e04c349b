"""What a study found: as a table, as JSON, and as one page of HTML that needs nothing else and runs no code."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict
from html import escape
from typing import Any, Final

from ai.files import brief
from ai.sweep.study import FinishedTrial, Study

Curve = tuple[list[tuple[float, float]], FinishedTrial]  # points, across from 0 to 1, and a value each
_BEST: Final = 10  # rows of the table
_SHOWN: Final = 300  # curves and rows of the page; the JSON has all
_LEFT: Final = 60  # of a plot's axis, in pixels
_STYLE: Final = """
:root { color-scheme: dark }
body { background: #090c18; color: #e8ecf4; font: 15px/1.5 system-ui, sans-serif; margin: 48px auto; max-width: 1000px }
h1 { font-weight: 300 } figcaption { color: #8a95ad; font-size: 13px } pre { overflow-x: auto }
figure { display: inline-block; margin: 0 28px 20px 0 }
svg text { fill: #8a95ad; font-size: 11px } .axis, .other, .best { fill: none; stroke: #3a445c }
.best { stroke: #70c8ff; stroke-width: 2 }
"""


def report(study: Study) -> dict[str, Any]:
    """Return all that a study found, as JSON can hold it."""
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


def table(study: Study, most: int = _BEST) -> str:
    """Return what a study found as a table of text, with at most so many trials."""
    plan, best, ranked = study.plan, study.best(), study.ranked()
    trials = f"{study.folder.name}: {len(study.trials)} of {plan.trials} trials, {len(plan.seeds)} seeds each"
    better = f"({'less' if study.metric.sign == 1 else 'more'} is better)"
    lines = [f"{trials}, compared by {plan.metric}, median of the seeds {better}"]
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


def shown_value(value: Any) -> str:
    """Return a knob's value as a table shows it."""
    if isinstance(value, float):
        return f"{value:.3g}"
    return value if isinstance(value, str) else json.dumps(value).replace('"', "")


def page(study: Study) -> str:
    """Return the page: the learning curves, each knob against the result, and the table. The best trial is blue."""
    ranked, best, plan = study.ranked()[:_SHOWN], study.best(), study.plan
    points = [point for trial in ranked for seed in trial.seeds for point in seed.curve]
    returns = study.metric.kind == "return" or any(point.success is None for point in points)
    reach, plots = max([1, *(point.at for point in points)]), []
    if ranked:
        seeds = [(seed, trial) for trial in ranked for seed in trial.seeds]
        curves = [
            ([(each.at / reach, each.mean_return if returns else each.success or 0.0) for each in seed.curve], trial)
            for seed, trial in seeds
        ]
        what = f"{'Mean return' if returns else 'Share that ended well'} without random actions, every seed"
        plots.append(_plot(what, ("0", f"{reach:,} {plan.unit}"), curves, best, "{:.3g}" if returns else "{:.0%}"))
    for name, dimension in plan.space.items() if ranked else ():
        dots = [([(dimension.place(trial.params[name]), trial.value or 0.0)], trial) for trial in ranked]
        first, last = map(shown_value, dimension.ends)
        plots.append(_plot(f"{name}, and {plan.metric}", (first, last), dots, best, "{:.3g}"))
    title = escape(study.folder.name)
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>{_STYLE}</style>'
        f"</head><body>\n<h1>{title}</h1>\n{''.join(plots)}<pre>{escape(table(study, _SHOWN))}</pre>\n</body></html>\n"
    )


def _plot(caption: str, across: tuple[str, str], lines: Iterable[Curve], best: FinishedTrial | None, shown: str) -> str:
    """Return a figure of lines of points, or of dots, where they have one point."""
    ordered = sorted(lines, key=lambda line: line[1] is best)  # above the others
    values = [value for line, _ in ordered for _, value in line]
    low, high = min(values, default=0.0), max(values, default=0.0)
    marks = []
    for line, trial in ordered:
        shares = [(value / 2 - low / 2) / (high / 2 - low / 2 or 1.0) for _, value in line]  # no overflow
        places = [(f"{_LEFT + 350 * x:.1f}", f"{180 - 170 * y:.1f}") for (x, _), y in zip(line, shares, strict=True)]
        colour = "best" if trial is best else "other"
        if len(places) == 1:
            marks.append(f'<circle class="{colour}" cx="{places[0][0]}" cy="{places[0][1]}" r="4"/>')
        else:
            marks.append(f'<polyline class="{colour}" points="{" ".join(map(",".join, places))}"/>')
    texts = [(_LEFT, 206, "start", across[0]), (420, 206, "end", across[1])]
    texts += [(_LEFT - 4, 190, "end", shown.format(low)), (_LEFT - 4, 12, "end", shown.format(high))]
    return (
        f'<figure><svg width="420" height="216"><path class="axis" d="M{_LEFT},0 V190 H420"/>'
        + "".join(f'<text x="{x}" y="{y}" text-anchor="{end}">{escape(text)}</text>' for x, y, end, text in texts)
        + f"{''.join(marks)}</svg><figcaption>{escape(caption)}</figcaption></figure>\n"
    )
