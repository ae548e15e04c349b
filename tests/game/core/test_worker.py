"""Workers with real processes. Whatever is waited for comes within moments; the limits are for when it does not."""

import gc
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from ai.training.config import Config
from ai.training.history import Checkpoint, History
from ai.training.lander_session import LanderSession
from ai.training.loop import Training
from ai.training.run import resume
from game.core import texts, worker
from game.core.worker import Worker, WorkerState
from game.core.worker_process import CREDIT, MOST_WAITING, MessageQueue
from tests.support import chores
from tests.support.chores import Echo, Latest, Tick, Trace

ROOT = Path(__file__).parents[3]
LIMIT = 60.0  # seconds
POSIX = pytest.mark.skipif(sys.platform == "win32", reason="signals")
TINY = Config(hidden=(8,), num_envs=32, learning_starts=64, batch_size=16, gradient_steps=1, replay_size=2000)


@pytest.fixture
def start():
    """Starts workers and sees to it that nothing of them is left."""
    before = set(threading.enumerate())
    started = []

    def start(function, *args, **kwargs):
        started.append(Worker(function, *args, **kwargs))
        return started[-1]

    yield start
    for each in started:
        each.close(0.0)
    assert multiprocessing.active_children() == []
    assert set(threading.enumerate()) <= before


def polled(worker, until):
    """Poll until `until(messages so far)` holds; return the messages."""
    messages, deadline = [], time.monotonic() + LIMIT
    while not until(messages):
        assert time.monotonic() < deadline, f"waited in vain: {worker.state} {worker.problem} {messages[-3:]}"
        time.sleep(0.002)
        messages += worker.poll()
    return messages


def over(worker):
    return polled(worker, lambda _: worker.state in (WorkerState.ENDED, WorkerState.FAILED))


def ticks(messages):
    return [each.number for each in messages if isinstance(each, Tick)]


def caught_up(worker):
    """Poll until a command comes back: whatever was ordered before it has been done."""
    worker.send("catch up")
    return polled(worker, lambda messages: Echo("catch up") in messages)


def test_every_message_comes_once_and_in_order(start):
    counter = start(chores.counting, 400)
    assert counter.state.name == "STARTING"
    messages = over(counter)
    assert ticks(messages) == list(range(400))
    assert counter.state is WorkerState.ENDED
    assert counter.problem == ""


def test_of_a_class_that_is_newest_only_the_latest_comes(start):
    counter = start(chores.counting, 300)
    while multiprocessing.active_children():  # nobody asks while it counts
        time.sleep(0.002)
    messages = over(counter)
    assert ticks(messages) == list(range(300))
    latest = [each.number for each in messages if isinstance(each, Latest)]
    assert len(latest) <= CREDIT + 1
    assert latest[-1] == 299
    assert latest == sorted(latest)


def test_what_waits_for_long_is_thinned_where_it_may_be():
    waiting = MessageQueue()
    for number in range(10 * MOST_WAITING):
        waiting.add([Trace(number)] + [Tick(number)] * (number % 1000 == 0))
    messages = waiting.take()
    traces = [each.number for each in messages if isinstance(each, Trace)]
    assert MOST_WAITING / 4 < len(traces) <= MOST_WAITING
    assert traces == sorted(traces)
    assert ticks(messages) == list(range(0, 10 * MOST_WAITING, 1000))
    assert not waiting


def test_much_that_must_not_be_lost_is_kept_and_handed_over_in_parts():
    waiting = MessageQueue()
    waiting.add(Tick(number) for number in range(3 * MOST_WAITING))
    first = waiting.take(10)
    assert ticks(first + waiting.take()) == list(range(3 * MOST_WAITING))


def test_a_paused_worker_stands_still_until_it_goes_on(start):
    counter = start(chores.counting)
    polled(counter, lambda messages: len(messages) > 3)
    counter.pause()
    assert counter.state.name == "PAUSED"
    caught_up(counter)
    assert ticks(caught_up(counter)) == []
    counter.resume()
    assert counter.state is WorkerState.RUNNING
    assert len(ticks(polled(counter, lambda messages: len(ticks(messages)) > 5))) > 5


def test_it_turns_at_the_pace_that_is_set(start):
    counter = start(chores.counting)
    counter.set_pace(1e-4)  # a turn in three hours: one may be due at once
    caught_up(counter)
    caught_up(counter)
    assert ticks(caught_up(counter)) == []
    counter.set_pace(None)
    assert len(ticks(polled(counter, lambda messages: len(ticks(messages)) > 20))) > 20


def test_commands_are_answered_in_order_also_while_paused(start):
    counter = start(chores.counting)
    counter.pause()
    for number in range(20):
        counter.send(number)
    messages = polled(counter, lambda messages: Echo(19) in messages)
    assert [each.command for each in messages if isinstance(each, Echo)] == list(range(20))


def test_a_generator_that_raises_fails_with_its_words(start):
    for error, words in (
        (FloatingPointError("the rate is too high"), "the rate is too high"),
        (ValueError(), "ValueError"),
        (KeyError("name"), "KeyError: 'name'"),
    ):
        failed = start(chores.failing, error)
        assert ticks(over(failed)) == [0, 1, 2]
        assert failed.state is WorkerState.FAILED
        assert failed.problem == texts.WORKER_RAISED.format(reason=words)


def test_what_does_not_start_cannot_be_sent_or_is_nonsense_fails_and_says_so(start):
    nonsense = texts.WORKER_NONSENSE.partition("{")[0]
    for function, arguments, begins, words in (
        (chores.babbling, (), nonsense, ""),
        (chores.strange, (), nonsense, "dict"),
        (chores.poisonous, (), nonsense, "poison"),
        (chores.unsendable, (), "", "unsendable.<locals>"),  # in whatever words this Python has for it
        (chores.counting, ("not a number",), "", "TypeError"),
    ):
        failed = start(function, *arguments)
        over(failed)
        assert failed.state is WorkerState.FAILED, function
        assert failed.problem.startswith(begins), function
        assert words in failed.problem, function
        polled(failed, lambda _, failed=failed: failed.gone)


@pytest.mark.parametrize(
    ("how", "problem"),
    [
        ({"code": 3}, texts.WORKER_EXITED.format(code=3)),
        pytest.param({"signal_name": "SIGKILL"}, texts.WORKER_KILLED.format(signal="SIGKILL"), marks=POSIX),
        pytest.param({"signal_name": "SIGSEGV"}, texts.WORKER_SIGNAL.format(signal="SIGSEGV"), marks=POSIX),
    ],
)
def test_a_process_that_dies_fails_with_the_cause(start, how, problem):
    dead = start(chores.dying, **how)
    messages = over(dead)
    assert dead.state is WorkerState.FAILED
    assert dead.problem == problem
    assert ticks(messages) in ([], [0])


def test_a_process_that_hangs_is_ended(start):
    hung = start(chores.hanging)
    polled(hung, lambda messages: ticks(messages) == [0])
    hung.patience = 0.3
    over(hung)
    assert hung.state is WorkerState.FAILED
    assert hung.problem == texts.WORKER_SILENT.format(seconds=0.3)
    polled(hung, lambda _: hung.gone)


def test_a_window_that_was_away_does_not_take_its_worker_for_hung(start):
    moments = [0.0]
    counter = start(chores.counting)
    counter.clock = lambda: moments[0]
    for _ in range(50):
        moments[0] += 3600.0  # asleep between any two polls
        counter.poll()
    assert counter.state in (WorkerState.STARTING, WorkerState.RUNNING)


@POSIX
def test_a_process_stopped_in_the_middle_of_a_message_holds_up_nothing(start):
    counter = start(chores.counting, weight=3_000_000)  # more than fits into a pipe
    polled(counter, lambda messages: len(ticks(messages)) > 3)
    os.kill(counter.process_id, signal.SIGSTOP)
    for number in range(3000):  # more than fits into the other direction
        counter.send("x" * 200)
        if number % 100 == 0:
            counter.poll()
    assert counter.state is WorkerState.RUNNING
    counter.patience = 0.1
    over(counter)
    assert counter.state is WorkerState.FAILED


@pytest.mark.slow
@POSIX
def test_a_run_killed_at_any_moment_can_be_loaded(start, tmp_path):
    keep = tmp_path / "run"
    rng = np.random.default_rng(5)
    decisions = []
    for _ in range(3):  # tests/ai/files/test_faults.py kills a writer at every step it takes on the disk
        run = start(chores.eager, TINY, 0, keep)
        polled(run, lambda messages: keep.exists() and sum(isinstance(each, Checkpoint) for each in messages) > 0)
        moment = time.monotonic() + float(rng.uniform(0.0, 0.3))
        polled(run, lambda _, moment=moment: time.monotonic() > moment)
        os.kill(run.process_id, signal.SIGKILL)
        over(run)
        decisions.append(resume(Training, keep).agent.decisions)
        assert len(History.read(keep).checkpoints) > 0
    assert all(decisions)


@pytest.mark.slow
@POSIX
def test_a_run_that_is_terminated_keeps_itself(start, tmp_path):
    run = start(LanderSession.live, TINY, 0, keep=tmp_path / "run")
    polled(run, lambda messages: any(isinstance(each, Checkpoint) and each.decisions > 0 for each in messages))
    os.kill(run.process_id, signal.SIGTERM)
    over(run)
    assert run.state is WorkerState.FAILED
    assert run.problem == texts.WORKER_SIGNAL.format(signal="SIGTERM")
    assert resume(Training, tmp_path / "run").agent.decisions > 0


def test_stopping_lets_the_generator_close(start, tmp_path):
    ending = start(chores.ending_well, tmp_path / "closed")
    polled(ending, ticks)
    ending.stop()
    over(ending)
    assert ending.state is WorkerState.ENDED
    polled(ending, lambda _: (tmp_path / "closed").exists())


def test_one_that_will_not_stop_is_ended(start, tmp_path, monkeypatch):
    monkeypatch.setattr(worker, "STOP_SECONDS", 0.2)
    stubborn = start(chores.ending_well, tmp_path / "closed", stubborn=True)
    polled(stubborn, ticks)
    stubborn.stop()
    over(stubborn)
    assert stubborn.state is WorkerState.ENDED
    polled(stubborn, lambda _: stubborn.gone)


def test_a_worker_that_is_forgotten_ends():
    forgotten = Worker(chores.counting)
    polled(forgotten, ticks)
    assert len(multiprocessing.active_children()) == 1
    del forgotten
    gc.collect()
    assert multiprocessing.active_children() == []


PARENT = """
import sys, time
from game.core.worker import Worker, WorkerState
from tests.support import chores
if __name__ == "__main__":
    workers = [Worker(chores.counting), Worker(chores.counting), Worker(chores.hanging)]
    workers[0].pause()
    while any(worker.state is WorkerState.STARTING for worker in workers):
        time.sleep(0.02)
        for worker in workers:
            worker.poll()
    print(*[worker.process_id for worker in workers], flush=True)
    {then}
"""


def parent(tmp_path, then):
    script = tmp_path / "parent.py"
    script.write_text(PARENT.format(then=then), encoding="utf-8")
    return subprocess.Popen(
        [sys.executable, str(script)], env=os.environ | {"PYTHONPATH": str(ROOT)}, stdout=subprocess.PIPE, text=True
    )


def is_gone(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks at processes by way of /proc")
@pytest.mark.parametrize(
    "then", ["time.sleep(600)", "import os, signal; os.kill(workers[1].process_id, signal.SIGSTOP)"]
)
def test_no_process_outlives_the_window(tmp_path, then):
    window = parent(tmp_path, then)
    pids = [int(pid) for pid in window.stdout.readline().split()]
    assert len(pids) == 3
    if "sleep" in then:
        window.kill()
    window.wait(LIMIT)
    window.stdout.close()
    deadline = time.monotonic() + LIMIT
    while not all(is_gone(pid) for pid in pids):
        assert time.monotonic() < deadline
        time.sleep(0.02)


def test_the_process_has_one_core_and_no_pygame(start):
    looking = start(chores.looking_around)
    (message,) = over(looking)
    assert message == {"modules": {"numpy"}, "threads": "1", "interrupted": True}


def test_closing_is_for_certain_and_may_be_done_at_any_time(start):
    at_once = start(chores.counting)
    at_once.close()
    hung = start(chores.hanging)
    polled(hung, ticks)
    hung.close(0.05)
    ended = start(chores.counting, 2)
    over(ended)
    for each in (at_once, hung, ended):
        each.close()
        each.send("nobody listens")
        each.pause()
        assert each.state is WorkerState.ENDED
        assert each.poll() is not None
        assert each.gone
    assert multiprocessing.active_children() == []


def test_the_program_can_be_imported_by_its_workers():
    # What a new process does with the program that started it.
    code = "import runpy, sys; runpy.run_path('main.py', run_name='__mp_main__'); print('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
