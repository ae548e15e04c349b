"""Real processes: a file that prints, reads, dies, never answers or has children harms nobody else."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from ai.pilots.process import PilotError, PilotProcess

LONG = 60.0  # seconds: only there so that a failure ends
OBSERVATION = np.zeros((2, 9), np.float32)
ORDINARY = """
import inspect, pickle, sys
from dataclasses import dataclass
from multiprocessing import get_context

@dataclass
class Plan:
    main: int = 3

def doubled(number):
    return 2 * number

plan = pickle.loads(pickle.dumps(Plan()))
assert plan == Plan() and Plan.__dataclass_fields__["main"].type is int
assert "class Plan" in inspect.getsource(Plan) and "plan.main" in inspect.getsource(sys.modules[__name__])
assert __spec__.name == __name__ and inspect.getmodule(doubled).__file__ == __file__

def act(observation):
    return plan.main
"""
RAISES_LATER = """
import signal

def late(*_):
    raise KeyError("a signal came")

signal.signal(signal.SIGALRM, late)

def act(observation):
    signal.setitimer(signal.ITIMER_REAL, 0.4)
    return 1
"""
FORKED = """
import os, time
if os.fork() == 0:
    open({mark!r}, "w").write(str(os.getpid()))
    time.sleep(600)

def act(observation):
    os._exit(3)
"""


@pytest.fixture
def started(tmp_path: Path):
    processes = []

    def start(source: str, name: str = "pilot.py") -> PilotProcess:
        (tmp_path / name).write_text(source)
        processes.append(PilotProcess(tmp_path / name))
        return processes[-1]

    yield start
    for process in processes:
        process.close()


def test_a_file_that_prints_and_reads_answers_all_the_same(started):
    process = started("import sys\nprint('loaded')\nread = sys.stdin.read()\ndef act(o):\n    print(o)\n    return 4")
    assert process.ready(LONG)
    assert process.ask(OBSERVATION, LONG).tolist() == [4, 4]
    assert process.ask(OBSERVATION[:1], LONG).tolist() == [4]
    process.close()
    assert process.gone
    with pytest.raises(PilotError, match="ended"):
        process.ask(OBSERVATION, LONG)


def test_a_file_is_an_ordinary_module_whatever_its_name(started):
    for name in ("pilot.py", "my pilot.py", "numpy.py", "queue.py", "números.py"):
        process = started(ORDINARY, name)
        assert process.ask(OBSERVATION, LONG).tolist() == [3, 3], name


def test_a_file_may_have_processes_of_its_own(started):
    process = started(
        "from multiprocessing import get_context\nimport math\n"
        "def act(o):\n    with get_context('spawn').Pool(1) as pool: return pool.map(math.floor, [2.5])[0]"
    )
    assert process.ask(OBSERVATION[:1], LONG).tolist() == [2]


def test_a_file_that_raises_goes_on_answering(started):
    process = started("n = 0\ndef act(o):\n    global n\n    n += 1\n    return 6 / (n - 1)")
    with pytest.raises(PilotError, match=r"^line 5: ZeroDivisionError"):
        process.ask(OBSERVATION[:1], LONG)
    with pytest.raises(PilotError, match="whole number"):
        process.ask(OBSERVATION[:1], LONG)
    assert not process.gone


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no such signals")
def test_what_a_signal_raises_between_two_decisions_is_said_at_the_next(started):
    process = started(RAISES_LATER)
    for _ in range(2):
        assert process.ask(OBSERVATION[:1], LONG).tolist() == [1]
        time.sleep(0.8)
        with pytest.raises(PilotError, match=r"^line 5: KeyError: 'a signal came'"):
            process.ask(OBSERVATION[:1], LONG)


def test_a_file_that_ends_its_process_is_reported(started):
    process = started("import os; os._exit(0)")
    with pytest.raises(PilotError, match="ended"):
        process.ready(LONG)
    assert process.gone


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no such processes")
def test_a_child_of_its_own_keeps_nobody_waiting_and_ends_with_it(started, tmp_path):
    mark = tmp_path / "mark"
    process = started(FORKED.format(mark=str(mark)))
    assert process.ready(LONG)
    with pytest.raises(PilotError, match="its process has ended"):
        process.ask(OBSERVATION, LONG)
    while not (number := mark.exists() and mark.read_text()):
        time.sleep(0.01)
    wait_for_the_end_of(int(number))


def wait_for_the_end_of(number: int) -> None:
    end = time.monotonic() + LONG
    while (stat := Path(f"/proc/{number}/stat")).exists() and ") Z " not in stat.read_text():
        assert time.monotonic() < end
        time.sleep(0.05)


def test_an_endless_loop_is_late_and_ends_with_the_process(started):
    process = started("def act(o):\n    while True: pass")
    assert process.ready(LONG)
    for _ in range(3):
        assert process.ask(OBSERVATION, 0.01) is None
    assert not process.ready()
    assert str(process.late("it took long", LONG)) == "line 2: it took long: its process was ended"
    assert process.gone


def test_an_answer_that_came_too_late_is_never_that_of_another_question(started):
    process = started("import time\ndef act(o):\n    time.sleep(float(o[1]))\n    return int(o[0])")
    assert process.ready(LONG)
    assert process.ask(np.array([[4, 0.3, *[0] * 7]]), 0.01) is None
    assert process.ask(np.array([[5, 0.0, *[0] * 7]]), LONG).tolist() == [5]


def test_one_that_answers_nothing_more_is_ended_all_the_same(started):
    process = started("import os, signal\ndef act(o):\n    os.kill(os.getpid(), signal.SIGSTOP)")
    assert process.ready(LONG)
    assert process.ask(OBSERVATION, 0.1) is None
    assert str(process.late("it took long")) == "it took long: its process was ended"
    assert process.gone


@pytest.mark.slow
def test_it_ends_with_whoever_started_it_however_that_ends(tmp_path: Path):
    (path := tmp_path / "pilot.py").write_text("while True: pass")
    for end in ("time.sleep(60)", "sys.exit()"):
        code = f"""
import sys, time
from pathlib import Path
from ai.pilots.process import PilotProcess
process = PilotProcess(Path({str(path)!r}))
print(process._process.pid, flush=True)
{end}
"""
        parent = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        assert parent.stdout
        with parent.stdout:
            number = int(parent.stdout.readline())
            if "sleep" in end:
                parent.kill()
            parent.wait(LONG)
        wait_for_the_end_of(number)


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "killpg"), reason="no such groups")
def test_a_terminals_ctrl_c_reaches_whoever_asks_and_never_the_file(tmp_path: Path):
    (path := tmp_path / "pilot.py").write_text("def act(o): return 0")
    code = f"""
import sys, time
from pathlib import Path
from ai.pilots.process import PilotProcess
process = PilotProcess(Path({str(path)!r}))
try:
    print(process._process.pid, flush=True)
    time.sleep(60)
except KeyboardInterrupt:
    print(process.ready(60))
"""
    with subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as parent:
        assert parent.stdout
        parent.stdout.readline()
        os.killpg(parent.pid, signal.SIGINT)  # while it begins
        assert parent.communicate(timeout=LONG) == ("True\n", "")
