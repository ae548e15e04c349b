"""What a study tells: the best trials with their spread over seeds, and how much each knob matters."""

from __future__ import annotations

from typing import Any, Final

from ai.files import brief
from ai.sweep.importance import Importance, importances
from ai.sweep.study import Study
from ai.sweep.table import settings

_BEST: Final = 10


def importance_of(study: Study) -> dict[str, Importance]:
    """Return how much each knob matters; nothing for a population, whose knobs change on the way."""
    if study.plan.population:
        return {}
    known = [trial for _, trial in sorted(study.trials.items()) if trial.value is not None]
    return importances(
        study.plan.dimensions(), [trial.params for trial in known], [trial.value or 0.0 for trial in known]
    )


def report(study: Study) -> dict[str, Any]:
    """Return all that a study tells, as JSON can hold it."""
    ranked = study.ranked()
    best = study.best()
    return {
        "study": study.folder.name,
        "plan": study.plan.to_json(),
        "finished": len(study.trials),
        "interrupted": sorted(study.begun),
        "damaged": study.damaged,
        "best": best.number if best else None,
        "importance": {
            name: {"share": each.share, "spread": each.spread} for name, each in importance_of(study).items()
        },
        "ranking": [trial.number for trial in ranked],
        "trials": [trial.to_json() for _, trial in sorted(study.trials.items())],
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
    if known := importance_of(study):
        lines.append("\nshare of the differences that a knob explains by itself (fANOVA)")
        lines += [f"  {name:24} {each.share:5.0%} ± {each.spread:.0%}" for name, each in known.items()]
    if best and (seed := best.best_seed) and (folder := study.run_folder(best, seed.seed)):
        lines.append(f"\nbest network: {folder}")
    return "\n".join(lines)
