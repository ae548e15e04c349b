"""Real processes: a file that prints, reads, dies, never answers or talks nonsense harms nobody else."""

import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from ai.pilots.process import PilotError, PilotProcess

LONG = 60.0  # seconds: only there so that a failure ends
OBSERVATION = np.zeros((2, 9), np.float32)
# The end that answers, found by what it is: standard output itself leads elsewhere by then.
FORGED = """
import os, stat
def act(observation):
    for number in range(3, 30):
        try:
            if stat.S_ISFIFO(os.fstat(number).st_mode):
                os.write(number, {bytes!r})
        except OSError:
            pass
    return 0
"""


@pytest.fixture
def started(tmp_path: Path):
    processes = []

    def start(source: str) -> PilotProcess:
        processes.append(PilotProcess(tmp_path / "pilot.py", source))
        return processes[-1]

    yield start
    for process in processes:
        process.close()


def test_a_file_that_prints_and_reads_answers_all_the_same(started):
    process = started("import sys\nprint('loaded')\nread = sys.stdin.read()\ndef act(o):\n    print(o)\n    return 4")
    assert process.ready(LONG)
    assert process.act(OBSERVATION, LONG).tolist() == [4, 4]
    assert process.act(OBSERVATION[:1], LONG).tolist() == [4]
    process.close()
    assert process.gone
    with pytest.raises(PilotError, match="ended"):
        process.act(OBSERVATION, LONG)


def test_a_file_that_raises_goes_on_answering(started):
    process = started("n = 0\ndef act(o):\n    global n\n    n += 1\n    return 6 / (n - 1)")
    with pytest.raises(PilotError, match=r"^line 5: ZeroDivisionError"):
        process.act(OBSERVATION[:1], LONG)
    with pytest.raises(PilotError, match="whole number"):
        process.act(OBSERVATION[:1], LONG)
    assert not process.gone


def test_a_file_that_ends_its_process_is_reported(started):
    process = started("import os; os._exit(0)")
    with pytest.raises(PilotError, match="ended"):
        process.ready(LONG)
    assert process.gone


def test_an_endless_loop_is_late_and_ends_with_the_process(started):
    process = started("def act(o):\n    while True: pass")
    assert process.ready(LONG)
    for _ in range(3):
        assert process.act(OBSERVATION, 0.01) is None
    assert not process.ready()
    assert str(process.late("it took long", LONG)) == "line 2: it took long: its process was ended"
    assert process.gone


def test_one_that_answers_nothing_more_is_ended_all_the_same(started):
    process = started("import os, signal\ndef act(o):\n    os.kill(os.getpid(), signal.SIGSTOP)")
    assert process.ready(LONG)
    assert process.act(OBSERVATION, 0.1) is None
    assert str(process.late("it took long")) == "it took long: its process was ended"
    assert process.gone


@pytest.mark.skipif(sys.platform == "win32", reason="pipes are found by their kind")
def test_forged_answers_are_refused(started):
    for forged in (b"\2\0\0\0a\x09", b"\3\0\0\0a\1\1", b"\1\0\0\0x", b"\xff\xff\xff\xff"):
        process = started(FORGED.format(bytes=forged))
        assert process.ready(LONG)
        with pytest.raises(PilotError):
            process.act(OBSERVATION[:1], LONG)


@pytest.mark.slow
def test_it_ends_with_whoever_started_it(tmp_path: Path):
    code = f"""
import time
from pathlib import Path
from ai.pilots.process import PilotProcess
process = PilotProcess(Path({str(tmp_path / "pilot.py")!r}), "while True: pass")
print(process._process.pid, flush=True)
time.sleep(60)
"""
    parent = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert parent.stdout
    with parent.stdout:
        number = int(parent.stdout.readline())
        parent.kill()
        parent.wait()
    end = time.monotonic() + LONG
    while Path(f"/proc/{number}").exists():
        assert time.monotonic() < end
        time.sleep(0.05)
