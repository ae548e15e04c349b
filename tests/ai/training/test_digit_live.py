from itertools import count

import numpy as np
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.config import DIGIT_PRESETS
from ai.digits.mnist import load_part
from ai.digits.training import DigitProgress, DigitTraining, confusion
from ai.digits.validation import EXAMPLES, Confusion
from ai.training import digit_session
from ai.training.digit_session import DigitSession
from ai.training.history import REVERTED, SettingChange, Validation
from ai.training.messages import RunStarted, Saved
from ai.training.run import resume

SMALL = DIGIT_PRESETS["classic"].changed(hidden=(16,), epochs=3, held_out=200, batch_size=50, ema_decay=0.9)


@pytest.fixture(scope="module")
def data():
    images, labels = load_part("test")
    return images[:700], labels[:700]


@pytest.fixture(autouse=True)
def every_step(monkeypatch):
    """Tell of every step, however fast they are."""
    monkeypatch.setattr(digit_session, "POINT_SECONDS", 0.0)


def kinds(messages, kind):
    return [each for each in messages if isinstance(each, kind)]


def test_a_run_reports_how_it_begins_how_it_stands_and_what_it_misreads(data):
    clock = map(float, count()).__next__  # it is measured for a share of the time, whatever else runs here
    messages = [each for turn in DigitSession.live(SMALL, 4, data=data, clock=clock) for each in turn]
    assert messages[0] == RunStarted(SMALL, 4, 0, "", 30)
    points, scores = kinds(messages, DigitProgress), kinds(messages, Validation)
    assert points[0].step == 1
    assert [one.seconds for one in points] == sorted(one.seconds for one in points)
    assert scores[-1].success > scores[0].success
    confusion = kinds(messages, Confusion)[-1]
    assert confusion.table.sum() == 200
    assert confusion.table.trace() / 200 == scores[-1].success
    assert len(confusion.images) == len(confusion.cells) > 0
    for row, column in {tuple(cell) for cell in confusion.cells.tolist()}:
        shown = (confusion.cells == (row, column)).all(axis=1).sum()
        assert row != column
        assert shown == min(confusion.table[row, column], EXAMPLES)


def test_the_network_is_that_of_a_run_without_a_window_and_one_that_is_closed_can_be_gone_on_with(data, tmp_path):
    run = DigitSession.live(SMALL, 4, keep=tmp_path / "run", data=data)
    for _ in range(8):
        next(run)
    run.close()
    assert resume(DigitTraining, tmp_path / "run", data=data).step == 7
    again = DigitSession.live(DIGIT_PRESETS["modern"], 0, resume=tmp_path / "run", keep=tmp_path / "run", data=data)
    assert next(again)[0] == RunStarted(SMALL, 4, 7, "", 30)
    for _ in again:
        pass
    training = DigitTraining(SMALL, 4, data)
    while not training.done:
        training.advance()
    improved = training.history[-1]["held_out"] == training.best
    assert (training.best_epoch is None) == improved, "a last network that is the best needs no word"
    kept = DigitClassifier.load(tmp_path / "run")
    np.testing.assert_array_equal(kept.network.values, training.best_classifier().network.values)


def test_a_run_that_is_asked_to_finish_is_kept_measured_and_can_be_gone_on_with(data, tmp_path):
    run = DigitSession.live(SMALL, 4, keep=tmp_path / "run", data=data)
    for _ in range(8):
        next(run)
    messages = run.send(("finish",)) + next(run)
    messages += run.send(("save", tmp_path / "asked meanwhile"))
    for turn in run:
        messages += turn
    saved, kept = kinds(messages, Saved)
    assert (saved.folder, saved.problem) == (tmp_path / "asked meanwhile", "")
    assert kept.folder == tmp_path / "run"
    assert kept.test > 0.1
    assert not kinds(messages, DigitProgress)
    assert resume(DigitTraining, tmp_path / "run", data=data).step == 7


def test_numbers_that_run_away_end_the_run_with_a_reason(data, tmp_path):
    wild = SMALL.changed(
        optimizer="sgd", learning_rate=1.0, activation="relu", output_activation=False, warm_up_epochs=0.0
    )
    with pytest.raises(FloatingPointError, match="learning rate"):
        for _ in DigitSession.live(wild.changed(hidden=(512, 512), epochs=20), keep=tmp_path / "run", data=data):
            pass


RUINED = SMALL.changed(epochs=40, learning_rate=0.02, augmentation=0.0)


def ruin(run):
    """Let a run learn for some epochs, with far too long steps from then on; return its messages."""
    messages = [each for _ in range(160) for each in next(run)]
    messages += run.send(("change", "learning_rate", 1.0)) + run.send(("change", "final_learning_rate", 1.0))
    messages += [each for _ in range(40) for each in next(run)]
    messages += run.send(("change", "learning_rate", 0.02)) + run.send(("change", "final_learning_rate", 1e-6))
    return messages + [each for _ in range(20) for each in next(run)]


def test_a_ruined_network_can_go_back_to_its_best(data):
    run = DigitSession.live(RUINED, 4, data=data)
    next(run)
    training = run.training
    ticks = count()
    training.clock = lambda: float(next(ticks))  # it is measured for a share of the time, whatever else runs here
    messages = ruin(run)
    assert [each.after for each in kinds(messages, SettingChange)] == [1.0, 1.0, 0.02, 1e-6]
    scores = [each.success for each in kinds(messages, Validation)]
    best = max(scores)
    assert scores[-1] < best - 0.2, "rate to 1 and back leaves a ruin"
    (went,) = run.send(("restore_best",))
    assert (went.name, went.after) == (REVERTED, best)
    table = confusion(training.held_labels, training.current().predict(training.held_images).argmax(axis=1))
    assert table.trace() / table.sum() == best
    messages = next(turn for _ in range(400) if kinds(turn := next(run), Validation))
    assert kinds(messages, Validation)[-1].success > best - 0.1, "and it learns on from there"


def test_what_is_shown_in_the_end_is_the_network_that_is_kept(data, tmp_path):
    run = DigitSession.live(RUINED, 4, keep=tmp_path / "run", data=data)
    ruin(run)
    messages = run.send(("finish",))
    for turn in run:
        messages += turn
    (kept,) = kinds(messages, Saved)
    training = resume(DigitTraining, tmp_path / "run", data=data)
    shown = kinds(messages, Confusion)[-1].table
    best = DigitClassifier.load(tmp_path / "run")
    assert np.array_equal(shown, confusion(training.held_labels, best.predict(training.held_images).argmax(axis=1)))
    assert shown.trace() / shown.sum() == training.best
    assert training.best is not None
    assert kinds(messages, Validation)[-1].success < training.best - 0.2, "the curve ends with the last one"
    assert training.history[kept.epoch - 1]["held_out"] == training.best, "and which it is, is said"
