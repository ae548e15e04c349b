"""Studies on Ray: two nodes on this machine, a killed worker, a killed node, a killed driver, and loopback only.

Everything is run by its command in processes of its own, so that nothing of Ray stays in the tests' process.
"""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from ai.sweep.study import Study
from ai.sweep.trial import trained
from tests.support.studies import TINY

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_spec("ray") is None or find_spec("optuna") is None, reason="needs the extra: sweep"),
    pytest.mark.skipif(not Path("/proc/net/tcp").exists(), reason="finds processes and sockets in /proc"),
]
ROOT = Path(__file__).parents[3]
LONG = 600  # seconds; only a hang takes that
SETTINGS = [
    part
    for name, value in TINY.items()
    for part in ("--set", f"{name}={list(value) if isinstance(value, tuple) else value}")
]
NEW = ["--env", "CartPole-v1", "--knobs", "learning_rate,tau", "--seeds", "2", "--validation", "5", *SETTINGS]


@pytest.fixture(scope="module")
def nodes():
    """A cluster of two nodes with a core each."""
    program = [sys.executable, "-m", "tests.support.ray_nodes"]
    process: Any  # which also says its address
    with subprocess.Popen(program, cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        process.address = process.stdout.readline().strip()
        assert process.address.startswith("127.0.0.1:")
        yield process
        process.stdin.close()
        process.wait(LONG)


@contextmanager
def sweep(folder, *options, **started):
    """Run `sweep` on a study in a folder; end it if a test fails meanwhile."""
    command = [sys.executable, "main.py", "sweep", "--study", f"{folder}/", *options]
    started |= {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, cwd=ROOT, text=True, **started) as process:
        try:
            yield process
        finally:
            process.kill()


def ended(process):
    """Wait for a sweep to end well; return what it printed."""
    out, errors = process.communicate(timeout=LONG)
    assert process.returncode == 0, errors
    return out


def finished(folder):
    return sorted(path.parent.name for path in folder.glob("trials/[0-9]*/trial.json"))


def wait_for(condition, driver):
    end = time.monotonic() + LONG
    while not (found := condition()):
        assert driver.poll() is None, driver.communicate()
        assert time.monotonic() < end, "it hangs"
        time.sleep(0.02)
    return found


def descendants(of):
    """Return the names of all processes below one, by id."""
    parents, names = {}, {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            pid = int(stat.parent.name)
            parents[pid] = int(stat.read_text().rpartition(")")[2].split()[1])
            names[pid] = (stat.parent / "cmdline").read_text()
        except OSError:  # it has ended meanwhile
            continue
    found, newest = set(), {of}
    while newest:
        newest = {pid for pid, parent in parents.items() if parent in newest} - found
        found |= newest
    return {pid: names[pid] for pid in found if pid in names}


def training_workers(of):
    return [pid for pid, name in descendants(of).items() if name.startswith("ray::trained")]


def listening(pids):
    """Return the addresses that processes listen on, as /proc writes them."""
    sockets = set()
    for pid in pids:
        try:
            links = [str(link.readlink()) for link in Path(f"/proc/{pid}/fd").iterdir()]
        except OSError:
            continue
        sockets |= {link[8:-1] for link in links if link.startswith("socket:[")}
    found = set()
    for table in ("tcp", "tcp6"):
        for line in Path(f"/proc/net/{table}").read_text().splitlines()[1:]:
            parts = line.split()
            if parts[3] == "0A" and parts[9] in sockets:  # listening
                found.add(parts[1].partition(":")[0])
    return found


def assert_whole(folder):
    """Every trial of a study is there once, and what Ray has brought is what this process trains, bit for bit."""
    study = Study.load(folder)
    assert (sorted(study.trials), study.damaged) == (list(range(study.design.trials)), [])
    assert len({json.dumps(trial.params) for trial in study.trials.values()}) == study.design.trials
    number, trial = max(study.trials.items())
    alone, files = trained(study.design, number, trial.params)
    assert replace(alone, seconds=trial.seconds) == trial
    kept = study.trial_folder(number) / "seed-1" / "online"
    assert [each.read_bytes() == files[f"seed-1/online/{each.name}"] for each in kept.iterdir()] == [True] * 7


def test_without_an_address_nothing_listens_but_on_this_machine_and_no_token_is_written(tmp_path):
    folder, home = tmp_path / "study", tmp_path / "home"
    home.mkdir(mode=0o500)
    with sweep(folder, *NEW, "--trials", "2", "--decisions", "400", env=os.environ | {"HOME": str(home)}) as driver:
        wait_for(lambda: training_workers(driver.pid), driver)
        opened = listening([driver.pid, *descendants(driver.pid)])
        out = ended(driver)
    assert opened <= {"0100007F", "0000000000000000FFFF00000100007F"}
    assert len(opened) == 2
    assert "2 of 2 trials" in out
    assert_whole(folder)
    assert not list(home.iterdir())


def _more_than(before, folder, pid):
    return len(finished(folder)) > before and training_workers(pid)


def test_a_signal_loses_no_finished_trial_and_the_study_goes_on(tmp_path):
    """Ctrl-C as a terminal sends it, to the whole group, and a termination of the process."""
    folder, options = tmp_path / "study", [*NEW, "--trials", "5", "--decisions", "1200"]
    for kill, number, code in ((os.killpg, signal.SIGINT, 0), (os.kill, signal.SIGTERM, 143)):
        before = len(finished(folder))
        with sweep(folder, *options, start_new_session=True) as driver:
            wait_for(partial(_more_than, before, folder, driver.pid), driver)
            kill(driver.pid, number)
            out, errors = driver.communicate(timeout=LONG)
        assert driver.returncode == code, errors
        assert "Traceback" not in errors
        assert "to go on: sweep" in out
        assert len(Study.load(folder).trials) > before
        options = ["--resume"]
    with sweep(folder, *options) as driver:
        ended(driver)
    assert_whole(folder)


def test_a_killed_worker_driver_and_node_lose_and_repeat_no_finished_trial(nodes, tmp_path):
    folder = tmp_path / "study"
    with sweep(folder, *NEW, "--trials", "6", "--decisions", "1200", "--address", nodes.address) as driver:
        wait_for(lambda: len(training_workers(nodes.pid)) == 2, driver)
        os.kill(training_workers(nodes.pid)[0], signal.SIGKILL)
        wait_for(lambda: len(finished(folder)) >= 2, driver)
        driver.send_signal(signal.SIGKILL)
    kept = {name: (folder / "trials" / name / "trial.json").stat() for name in finished(folder)}
    assert 2 <= len(kept) < 6
    with sweep(folder, "--resume", "--address", nodes.address) as driver:
        wait_for(lambda: len(finished(folder)) > len(kept) and len(training_workers(nodes.pid)) == 2, driver)
        nodes.stdin.write("take the second node away\n")
        nodes.stdin.flush()
        assert nodes.stdout.readline().strip() == "gone"
        out = ended(driver)
    assert "6 of 6 trials" in out
    for name, stat in kept.items():
        now = (folder / "trials" / name / "trial.json").stat()
        assert (now.st_ino, now.st_mtime_ns) == (stat.st_ino, stat.st_mtime_ns), "a finished trial was written again"
    assert_whole(folder)
