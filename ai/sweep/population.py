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

from ai.sweep.space import Space
from ai.sweep.study import FinishedTrial, Study
from ai.sweep.trial import Asked

_SHARE: Final = 4  # one member in four is replaced by a copy of one of the best quarter
_REDRAWN: Final = 0.25  # chance that a copied knob is drawn anew, as in the paper
_FACTORS: Final = (0.8, 1.2)


class Population:
    """The trials that a population has left, as the driver asks for them (`ai.sweep.search.Search`)."""

    def __init__(self, study: Study) -> None:
        self._study = study
        known = {*study.trials, *study.damaged}
        self._left = [number for number in range(study.plan.trials) if number not in known]

    def next(self) -> Asked | None:
        """Return the next trial; None for no more, or as long as the generation before it is not whole."""
        asked = proposed(self._study, self._left[0]) if self._left else None
        if asked is not None:
            self._left.pop(0)
        return asked

    def falls_behind(self, trial: FinishedTrial) -> bool:  # noqa: ARG002
        """Return False: the worst are replaced when a generation ends."""
        return False

    def tell(self, trial: FinishedTrial) -> None:
        """Pass over the end of a trial: the study has it."""

    def importance(self) -> dict[str, float]:
        """Return nothing: knobs change on the way."""
        return {}


def proposed(study: Study, number: int) -> Asked | None:
    """Return what trial `number` is asked to do; None as long as the generation before it is not whole."""
    plan = study.plan
    rng, generation = np.random.default_rng([plan.seed, number]), plan.generation(number)
    if generation == 0:
        return Asked(number, {name: dimension.draw(rng) for name, dimension in plan.space.items()})
    before = study.generation(generation - 1)
    if len(before) < plan.population:
        return None
    own, few, sign = before[number % plan.population], max(1, plan.population // _SHARE), study.metric.sign
    ranked = sorted(before, key=lambda trial: (trial.value is None, sign * (trial.value or 0.0), trial.number))
    if all(own is not each for each in ranked[-few:]):
        return Asked(number, own.params, own)
    source = ranked[int(rng.integers(few))]
    return Asked(number, explored(source.params, plan.space, rng), source)


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
