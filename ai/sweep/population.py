"""Population-based training (Jaderberg et al. 2017), in generations.

Every member of a generation trains for the same number of decisions. Then the worst quarter goes on with copies of
runs of the best quarter, and with their knobs, changed a little; the others go on with their own. A member's run
goes on as `train --resume DIR --set NAME=VALUE` does.

The paper lets members copy whenever they are ready. Here a generation waits for its last member. So what a member is
asked to do follows from the finished trials and the study's seed alone: not from the number of workers, nor from who
was first, nor from whether the study was interrupted.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ai.sweep.results import FinishedTrial
from ai.sweep.space import Space
from ai.sweep.study import Study
from ai.sweep.trial import Asked

SHARE: Final = 4  # one member in four is replaced by a copy of one of the best quarter
_REDRAWN: Final = 0.25  # chance that a copied knob is drawn anew, as in the paper
_FACTORS: Final = (0.8, 1.2)


def proposed(study: Study, number: int) -> Asked | None:
    """Return what trial `number` is asked to do; None as long as the generation before it is not whole."""
    plan = study.plan
    rng, space = np.random.default_rng([plan.seed, number]), plan.dimensions()
    generation = plan.generation(number)
    if generation == 0:
        return Asked(number, {name: dimension.draw(rng) for name, dimension in space.items()})
    before = study.generation(generation - 1)
    if len(before) < plan.population:
        return None
    own = before[number % plan.population]
    ranked, few = _ranked(study, before), max(1, plan.population // SHARE)
    if all(own is not each for each in ranked[-few:]):
        return Asked(number, own.params, own)
    source = ranked[int(rng.integers(few))]
    return Asked(number, explored(source.params, space, rng), source)


def explored(params: dict[str, Any], space: Space, rng: np.random.Generator) -> dict[str, Any]:
    """Return knobs near those given: each times 0.8 or 1.2, or the next choice, or now and then drawn anew."""
    changed = {}
    for name, dimension in space.items():
        if rng.random() < _REDRAWN:
            changed[name] = dimension.draw(rng)
        elif dimension.choices:
            step = 1 / max(1, len(dimension.choices) - 1)
            changed[name] = dimension.at(dimension.place(params[name]) + step * rng.choice((-1, 1)))
        else:
            value = min(dimension.high, max(dimension.low, params[name] * rng.choice(_FACTORS)))
            changed[name] = round(value) if dimension.whole else float(value)
    return changed


def _ranked(study: Study, trials: list[FinishedTrial]) -> list[FinishedTrial]:
    """Return trials from the best to the worst; those without a value are the worst."""
    sign = 1 if study.metric.mode == "min" else -1
    return sorted(trials, key=lambda trial: (trial.value is None, sign * (trial.value or 0.0), trial.number))
