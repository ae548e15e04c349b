"""What a study tells: the best trials with their spread over seeds, and how much each knob matters."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any, Final

from ai.files import brief
from ai.sweep.space import shown_value
from ai.sweep.study import Study

_BEST: Final = 10


def report(study: Study) -> dict[str, Any]:
    """Return all that a study tells, as JSON can hold it."""
    ranked = study.ranked()
    best = study.best()
    return {
        "study": study.folder.name,
        "plan": asdict(study.plan),
        "finished": len(study.trials),
        "damaged": study.damaged,
        "best": best.number if best else None,
        "importance": study.importance,
        "ranking": [trial.number for trial in ranked],
        "trials": [asdict(trial) for _, trial in sorted(study.trials.items())],
    }


def told(study: Study) -> str:
    """Return what a study tells as a table of text."""
    plan, best = study.plan, study.best()
    better = "less" if study.metric.mode == "min" else "more"
    trials = f"{study.folder.name}: {len(study.trials)} of {plan.trials} trials, {len(plan.seeds)} seeds each"
    lines = [f"{trials}, compared by {plan.metric}, {plan.judge} of the seeds ({better} is better)"]
    if study.damaged:
        lines.append(f"of {len(study.damaged)} more, the files cannot be read: {', '.join(map(str, study.damaged))}")
    if senseless := [trial for _, trial in sorted(study.trials.items()) if trial.problem]:
        numbers = ", ".join(str(trial.number) for trial in senseless)
        lines.append(f"of {len(senseless)}, the settings make no sense: {numbers}: {brief(senseless[0].problem)}")
    ranked = study.ranked()
    if best and ranked[0] is not best:  # a population's best is one of its last generation
        ranked = [best, *(trial for trial in ranked if trial is not best)]
    if not ranked:
        return "\n".join([*lines, "no trial has a result yet"])
    lines.append(f"\n{'trial':>5} {plan.metric:>12} {'of the seeds':>24}  settings")
    for trial in ranked[:_BEST]:
        low, high = min(trial.values), max(trial.values)
        spread = f"{study.shown(low)} to {study.shown(high)}"
        ended = f", stopped after {trial.at:,} {plan.unit}" if trial.stopped else ""
        lines.append(f"{trial.number:>5} {study.shown(trial.value):>12} {spread:>24}  {settings(trial.params)}{ended}")
    if study.importance:
        lines.append("\nshare of each knob in setting the best trials apart (PED-ANOVA)")
        lines += [f"  {name:24} {share:5.0%}" for name, share in study.importance.items()]
    if best and (seed := best.best_seed) and (folder := study.run_folder(best, seed.seed)):
        lines.append(f"\nbest network: {folder}")
    return "\n".join(lines)


def settings(params: dict[str, Any]) -> str:
    """Return the settings of a trial in one line."""
    return " ".join(f"{name}={shown_value(value)}" for name, value in params.items())


def duration(seconds: float) -> str:
    """Return a length of time as a person says it."""
    minutes = round(seconds / 60)
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{minutes} min" if minutes < 120 else f"{minutes // 60} h {minutes % 60:02} min"
