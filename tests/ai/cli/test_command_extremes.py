"""Commands at the ends of what can be said to them: each refusal is a sentence, before anything is begun.

Nothing here learns or flies: a case that gets that far fails, so none takes long.
"""

from __future__ import annotations

import io
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ai.digits.config import DIGIT_PRESETS
from ai.digits.training import DigitTraining
from ai.lander.environment import LanderEnv
from ai.run import TRAINING_FILE
from ai.training.config import PRESETS
from ai.training.loop import Training
from ai.training.run import save
from main import main

ROOT = Path(__file__).parents[3]
MODEL = str(ROOT / "models" / "lander" / "modern")
SMALL = PRESETS["modern"].changed(
    num_envs=2, hidden=(4,), batch_size=8, learning_starts=8, gradient_steps=1, replay_size=100
)
READER = DIGIT_PRESETS["classic"].changed(hidden=(4,), held_out=100)

TRAIN = ["train", "--output", "new", "--decisions", "100"]
TRAIN_DIGITS = ["train-digits", "--output", "new"]
EVALUATE = ["evaluate", "--model", MODEL]
DEEP = "[" * 100_000
LONG = "x" * 100_000
NUMBERS = ["-1", "nan", "-inf", "1e999", "", "9" * 5_000, "1\N{EN DASH}2"]
COUNTS = ["0", "1.5", *NUMBERS]
SOME = ["-1", "nan", "1" * 400]  # of options that are read as another one is
PATHS = ["", "/", "file", "file/x", "loop/x", "full", "/dev/null/x", "/proc/nowhere", "x" * 300, "a\0b", "\ud800",
         "\x1b[2J"]  # fmt: skip
UNREADABLE = ["", "file", "loop", "full", "a\0b", "nowhere", "deep", "list", "\x1b[2J", "empty"]
WORDS = ["", LONG, "classic\0", "\N{EN DASH}", "\ud800", "\x1b[2J"]
ENVS = [*WORDS, "a/b/c", "../x", "a:b:c", ":", "CartPole-v99", "CartPole-v" + "9" * 5_000]
SETTINGS = [
    "", "=", "=1", "x=1", LONG, "hidden", "env=null", "env=[]", "env=", "hidden=null", "hidden=[]", "hidden=[[1]]",
    f"hidden={DEEP}", "hidden=[1e999]", "hidden=[0]", f"hidden=[1{'0' * 400}]", "learning_rate=NaN", "learning_rate=0",
    "learning_rate=[]", 'learning_rate="1"', "learning_rate=", "n_step=1e999", "n_step=2.0", f"n_step={'9' * 5_000}",
    "reward_weights=3", "weights=null", 'weights={"time": 1e999}', 'weights={"time": null}', 'weights={"x": 1}',
    'weights={"time": "x"}', "optimizer={}", "spawn=null", "batch_size=true", "double=1", "num_envs=1e9",
    "discount=1.1",
]  # fmt: skip
DIGIT_SETTINGS = [
    "x=1", "filters=[]", "filters=[8,8,8,8,8,8]", "filters=[1e999]", "kernel=9e9", "hidden=null", f"hidden={DEEP}",
    "epochs=0", "epochs=1.5", "held_out=60000", "batch_size=0", "dropout=NaN", "cost=[]", "convolutions=2",
    "augmentation=1e999", "ema_decay=1", "activation={}",
]  # fmt: skip

_PYTHONS_WORDS = re.compile(r"__|\b(None|True|False|NoneType|argument after|keyword)\b|[{(]'")
CASES: list[list[str]] = [
    *([*command, value] for command in ([*TRAIN, "--decisions"], [*TRAIN_DIGITS, "--epochs"]) for value in COUNTS),
    *([*TRAIN, "--seconds", value] for value in ("0", *NUMBERS)),
    *([*command, value] for command in ([*TRAIN, "--validation"], [*TRAIN_DIGITS, "--seconds"])
      for value in ("0", *SOME)),
    *([*command, "--seed", value]
      for command in (TRAIN, TRAIN_DIGITS, EVALUATE) for value in ("1.5", *SOME)),
    *([*EVALUATE, "--episodes", value] for value in ("0", *SOME, "1000000000")),
    *([*command, word] for command in (
        [*TRAIN, "--preset"], [*TRAIN_DIGITS, "--preset"], [*EVALUATE, "--spawn"], ["physics", "--exhibit"])
      for word in WORDS),
    *([*TRAIN, "--env", env] for env in ENVS),
    *([*TRAIN, "--set", setting] for setting in SETTINGS),
    *([*TRAIN_DIGITS, "--set", setting] for setting in DIGIT_SETTINGS),
    *([*command, "--output", path] for command in (TRAIN, TRAIN_DIGITS) for path in PATHS),
    *([*command, path] for path in UNREADABLE for command in (
        ["train", "--decisions", "100", "--resume"], ["train-digits", "--resume"], ["evaluate", "--model"],
        ["evaluate-digits", "--model"])),
    *(["--user-dir", path, "physics"] for path in ("", "/", "loop", "a\0b", "\ud800")),
    *([*command, argument]
      for command in ([], ["train"], ["evaluate"], ["train-digits"], ["physics"])
      for argument in ("--nonsense", LONG, "\ud800")),
    ["--windowed", "--fullscreen"], ["train"], ["train-digits"], ["evaluate"], ["evaluate-digits"],
]  # fmt: skip


def in_short(arguments: list[str]) -> str:
    shown = [argument if argument != MODEL else "MODEL" for argument in arguments]
    return ascii(" ".join(each if len(each) < 24 else f"{each[:12]}[{len(each)}]" for each in shown))[1:-1]


def went_on(*_, **__):
    raise AssertionError("it went on")


@pytest.fixture
def refused(tmp_path, monkeypatch, capsys):
    """Runs a command that has to be refused, and returns what it says; the folder it runs in stays as it was."""
    for kind, method in ((Training, "advance"), (DigitTraining, "advance"), (LanderEnv, "step")):
        monkeypatch.setattr(kind, method, went_on)
    monkeypatch.setattr("game.start.play", went_on)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("dear diary")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "letter").write_text("dear you")
    (tmp_path / "empty").mkdir()
    for name, content in (("deep", DEEP), ("list", "[]")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "config.json").write_text(content)
    if sys.platform != "win32":
        (tmp_path / "loop").symlink_to(tmp_path / "loop")

    def refused(arguments):
        before = sorted(map(str, tmp_path.rglob("*")))
        try:
            code: Any = main(arguments)
        except SystemExit as ended:
            code = ended.code
        stderr = capsys.readouterr().err
        assert code in (1, 2)
        assert 0 < len(stderr) < 1_000
        assert stderr.count("\n") <= 4
        assert stderr.replace("\n", "").isprintable()
        assert "Traceback" not in stderr
        assert not _PYTHONS_WORDS.search(stderr)
        assert sorted(map(str, tmp_path.rglob("*"))) == before
        return stderr

    return refused


@pytest.mark.slow
def test_what_makes_no_sense_is_refused_in_a_sentence_before_anything_is_begun(subtests, refused):
    for arguments in CASES:
        with subtests.test(in_short(arguments)):
            refused(arguments)


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """A run of each kind on disk, with a score, and with a history."""
    folder = tmp_path_factory.mktemp("runs")
    training = Training(SMALL, 3, validation_episodes=2)
    training.advance()
    training.evaluate()
    save(training, folder / "lander", state=False)
    images, labels = np.zeros((200, 28, 28), np.float32), np.zeros(200, np.uint8)
    digits = DigitTraining(READER, data=(images, labels))
    digits.advance()
    save(digits, folder / "digits")
    return folder


WRONG = [None, "x", [], {}, True, -1, 1.5, float("nan"), 10**400]
WRONG_OF = [
    *(("lander", name, value) for name in ("seed", "episodes") for value in WRONG),
    *(("lander", "seconds", value) for value in WRONG if value != 1.5),
    *(("lander", "best", value) for value in WRONG if value is not None),
    *(("lander", "best.success", value) for value in ("x", None, True, 10**400)),
    *(("digits", name, value) for name in ("step", "preset") for value in WRONG),
    *(("digits", "changes", value) for value in WRONG if value not in ([], {})),
]


RESUME = {"lander": ["train", "--decisions", "100", "--resume"], "digits": ["train-digits", "--resume"]}


def test_a_run_whose_file_says_nonsense_is_not_gone_on_with(subtests, refused, runs, monkeypatch):
    images, labels = np.zeros((200, 28, 28), np.float32), np.zeros(200, np.uint8)
    monkeypatch.setattr("ai.digits.training.load_part", lambda part: (images, labels))
    contents = [(kind, content.encode("latin-1")) for content in (DEEP, "\xff", "", "null", "[]") for kind in RESUME]
    for kind, name, value in WRONG_OF:
        described = json.loads((runs / kind / TRAINING_FILE).read_text())
        place, _, inner = name.rpartition(".")
        (described[place] if place else described)[inner] = value
        contents.append((kind, json.dumps(described).encode()))
    for kind, content in contents:
        with subtests.test(kind=kind, content=content[:300]):
            file = runs / kind / TRAINING_FILE
            sound = file.read_bytes()
            file.write_bytes(content)
            try:
                assert TRAINING_FILE in refused([*RESUME[kind], str(runs / kind)])
            finally:
                file.write_bytes(sound)


class Terminal(io.TextIOWrapper):
    """A terminal that knows no more letters than its encoding."""

    def __init__(self, encoding):
        self.written = io.BytesIO()
        super().__init__(self.written, encoding=encoding, errors="strict", write_through=True)

    @property
    def shown(self):
        return self.written.getvalue().decode(self.encoding)


STRANGE = "m\N{LATIN SMALL LETTER U WITH DIAERESIS}n\N{EN DASH}\N{GREEK SMALL LETTER EPSILON}\udcff"


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="file names are letters there, not bytes")
@pytest.mark.parametrize("encoding", ["ascii", "utf-8"])
def test_a_terminal_that_knows_few_letters_ends_no_command(encoding, tmp_path, runs, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(runs / "lander", STRANGE)
    terminal = Terminal(encoding), Terminal(encoding)
    monkeypatch.setattr(sys, "stdout", terminal[0])
    monkeypatch.setattr(sys, "stderr", terminal[1])
    assert main(["train", "--resume", STRANGE, "--decisions", "2"]) == 1
    assert "this run has taken" in terminal[1].shown
    assert main(["evaluate", "--model", STRANGE, "--episodes", "2"]) == 0  # no landing: dashes for times
    assert "mean time" in terminal[0].shown
    assert main(["evaluate", "--model", f"no {STRANGE}"]) == 1
    assert main(["train", "--output", "x", "--decisions", "1", "--preset", STRANGE]) == 1
    assert "--preset is one of" in terminal[1].shown
    for command in ("train", "evaluate", "train-digits", "evaluate-digits", "physics"):
        with pytest.raises(SystemExit, match="0"):
            main([command, "--help"])


@pytest.mark.slow
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device")
def test_an_output_that_takes_nothing_ends_a_command_in_a_sentence():
    with Path("/dev/full").open("w") as output:
        process = subprocess.run([sys.executable, "main.py", "evaluate", "--model", MODEL, "--episodes", "1"], cwd=ROOT,
                                 stdout=output, stderr=subprocess.PIPE, timeout=120, check=False)  # fmt: skip
    assert process.returncode == 1
    assert process.stderr == b"tranquility: cannot write: No space left on device\n"
