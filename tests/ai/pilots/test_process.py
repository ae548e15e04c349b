"""Real processes: a file that prints, reads, dies, never answers or has children harms nobody else."""

import os
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

@dataclass
class Plan:
    main: int = 3

plan = pickle.loads(pickle.dumps(Plan()))
assert plan == Plan() and "class Plan" in inspect.getsource(Plan)

def act(observation):
    return plan.main
"""
FORKED = """
import os, time
if os.fork() == 0:
    open({mark!r}, "w").write(str(os.getpid()))
    time.sleep(600)

def act(observation):
    return 0
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
    for name in ("my pilot.py", "numpy.py", "queue.py"):
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


def test_a_file_that_ends_its_process_is_reported(started):
    process = started("import os; os._exit(0)")
    with pytest.raises(PilotError, match="ended"):
        process.ready(LONG)
    assert process.gone


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no such processes")
def test_a_child_of_its_own_ends_with_it(started, tmp_path):
    mark = tmp_path / "mark"
    process = started(FORKED.format(mark=str(mark)))
    assert process.ready(LONG)
    while not (number := mark.exists() and mark.read_text()):
        time.sleep(0.01)
    process.close()
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
    assert str(process.ended("it took long")) == "it took long"
    assert process.gone


def test_an_answer_that_came_too_late_is_never_that_of_another_question(started):
    process = started("import time\ndef act(o):\n    time.sleep(float(o[1]))\n    return int(o[0])")
    assert process.ready(LONG)
    assert process.ask(np.array([[4, 0.3, *[0] * 7]]), 0.01) is None
    assert process.ask(np.array([[5, 0.0, *[0] * 7]]), LONG).tolist() == [5]


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
