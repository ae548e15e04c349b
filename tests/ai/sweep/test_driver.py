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
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from ai.sweep.study import Asked, Files, Study, write_files
from tests.support.studies import TINY, networks_in, run_alone

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


def under_way(folder):
    """The settings of trials that have begun and are not finished, by number."""
    return {number: asked.params for number, asked in Study.load(folder).under_way.items()}


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


def assert_as_alone(folder):
    """Every trial of a study is there once and is what the same settings give without Ray, bit for bit."""
    study = Study.load(folder)
    assert sorted(study.trials) == list(range(study.plan.trials))
    assert study.damaged == []
    # The runs of each trial; the study forgets the states of members that others went on from.
    kept: dict[int | None, Files] = {None: {}}
    for number, trial in sorted(study.trials.items()):
        parent = None if trial.parent is None else study.trials[trial.parent]
        alone, runs = run_alone(study.plan, Asked(number, trial.params, trial.parent), parent, kept[trial.parent])
        kept[number] = runs
        write_files(runs, folder.parent / f"alone-{number}")
        assert networks_in(folder.parent / f"alone-{number}" / "seed-1") == networks_in(
            study.trial_folder(number) / "seed-1"
        )
        assert (alone.value, [seed.curve for seed in alone.seeds]) == (trial.value, [s.curve for s in trial.seeds])


def test_a_population_on_two_nodes_is_what_it_is_alone(nodes, tmp_path):
    folder = tmp_path / "study"
    options = ["--search", "population", "--population", "2", "--trials", "4", "--decisions", "400"]
    with sweep(folder, *NEW, *options, "--address", nodes.address) as driver:
        ended(driver)
    assert_as_alone(folder)
    assert any(trial.parent is not None for trial in Study.load(folder).trials.values())


def test_without_an_address_nothing_listens_but_on_this_machine_and_no_token_is_written(tmp_path):
    folder, home = tmp_path / "study", tmp_path / "home"
    home.mkdir(mode=0o500)
    options = [*NEW, "--trials", "2", "--decisions", "400", "--workers", "1"]
    with sweep(folder, *options, env=os.environ | {"HOME": str(home)}) as driver:
        wait_for(lambda: finished(folder), driver)
        opened = listening([driver.pid, *descendants(driver.pid)])
        ended(driver)
    assert opened <= {"0100007F", "0000000000000000FFFF00000100007F"}
    assert len(opened) == 2
    assert len(finished(folder)) == 2
    assert not list(home.iterdir())


def test_a_termination_ends_in_143_whenever_it_comes_and_the_study_goes_on(tmp_path):
    """To the process alone, and to its whole group, as `timeout` does."""
    folder = tmp_path / "study"
    options = [*NEW, "--trials", "3", "--decisions", "1200", "--workers", "1"]
    began = [
        (lambda driver: descendants(driver.pid), os.kill),  # Ray begins
        (lambda driver: training_workers(driver.pid), os.kill),
        (lambda driver: finished(folder), os.killpg),
    ]
    for begun, kill in began:
        with sweep(folder, *options, start_new_session=True) as driver:
            wait_for(partial(begun, driver), driver)
            kill(driver.pid, signal.SIGTERM)
            out, errors = driver.communicate(timeout=LONG)
        assert driver.returncode == 143, errors
        assert "SIGTERM" not in errors
        assert "--resume" in out
        options = ["--resume", "--workers", "1"]
    with sweep(folder, *options) as driver:
        ended(driver)
    assert_as_alone(folder)


def test_a_killed_worker_driver_and_node_lose_and_repeat_no_finished_trial_and_change_none(nodes, tmp_path):
    """Its second node is gone afterwards, which the other tests bear."""
    folder = tmp_path / "study"
    with sweep(folder, *NEW, "--trials", "5", "--decisions", "1200", "--address", nodes.address) as driver:
        wait_for(lambda: len(training_workers(nodes.pid)) == 2, driver)
        os.kill(training_workers(nodes.pid)[0], signal.SIGKILL)
        wait_for(lambda: len(finished(folder)) >= 2, driver)
        driver.send_signal(signal.SIGKILL)
    kept = {name: (folder / "trials" / name / "trial.json").stat() for name in finished(folder)}
    assert 2 <= len(kept) < 5
    asked = under_way(folder)
    assert asked
    with sweep(folder, "--resume", "--address", nodes.address) as driver:
        wait_for(lambda: len(finished(folder)) > len(kept), driver)
        nodes.stdin.write("take the second node away\n")
        nodes.stdin.flush()
        assert nodes.stdout.readline().strip() == "gone"
        out = ended(driver)
    assert "5 of 5 trials" in out
    for name, stat in kept.items():
        now = (folder / "trials" / name / "trial.json").stat()
        assert (now.st_ino, now.st_mtime_ns) == (stat.st_ino, stat.st_mtime_ns), "a finished trial was written again"
    study = Study.load(folder)
    for number, params in asked.items():
        assert study.trials[number].params == params, "an interrupted trial has kept its settings"
    assert len({json.dumps(trial.params) for trial in study.trials.values()}) == 5
    assert_as_alone(folder)
