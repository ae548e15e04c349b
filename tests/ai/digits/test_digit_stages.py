from pathlib import Path

import numpy as np

from ai.digits.ablation import drawings, stage_accuracy
from ai.digits.classifier import load_part

MODELS = Path(__file__).parents[3] / "models" / "digits"
ALL = {"crop": True, "fit": True, "width": True, "centre": True}


def test_steps_that_are_left_out_cost_accuracy_and_the_same_question_has_the_same_answer():
    answers = stage_accuracy({"classic": MODELS / "classic"}, count=80)
    assert next(answers) == []
    (whole,), (uncropped,), (again,) = (answers.send(steps) for steps in (ALL, {**ALL, "crop": False}, ALL))
    assert whole == again
    assert whole.count == 80
    assert dict(uncropped.steps)["crop"] is False
    assert whole.read["classic"] > 0.9 > uncropped.read["classic"] + 0.2
    assert answers.send(None) == []


def test_drawings_are_anywhere_of_any_size_and_with_any_pen():
    images, _ = load_part("test")
    drawn = drawings(images[:30], np.random.default_rng(0))
    spans = [np.ptp(np.flatnonzero(canvas.max(axis=1) > 0.5)) for canvas in drawn]
    assert max(spans) > 1.5 * min(spans)
    assert all(canvas.shape == (160, 160) and canvas.min() >= 0 and 0.9 < canvas.max() <= 1 for canvas in drawn)
    inked = [float(canvas.sum()) / span**2 for canvas, span in zip(drawn, spans, strict=True)]
    assert max(inked) > 2 * min(inked)
