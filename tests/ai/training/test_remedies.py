"""Hints at what was changed by hand, on a real run that lands after two seconds, is then broken, and mended."""

import json
from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Any

import pytest

from ai.training.captions import caption
from ai.training.config import PRESETS, Config
from ai.training.curves import RecentCurves
from ai.training.edits import Edit
from ai.training.hints import RULES, Adviser
from ai.training.history import Checkpoint, History, Point, SettingChange
from ai.training.lander_session import LanderSession
from tests.support.recordings import recorded

# As `benchmarks.remedies` has it.
NEAR = PRESETS["modern"].changed(
    num_envs=128, spawn="near", hidden=(64,), gradient_steps=8, learning_starts=500, epsilon_decisions=4_000,
    schedule_decisions=30_000,
)  # fmt: skip
HEALTHY = 38_000  # decisions after which it lands, nine times of ten
PACE = 10_000.0  # decisions a second of the clock that hints go by


class Watched:
    """A live run with its hints, as the scene follows it."""

    def __init__(self, config: Config, resume: Path | None = None, keep: Path | None = None) -> None:
        clock = count(0.0, config.num_envs / PACE).__next__
        self._run = LanderSession.live(config, 0, keep=keep, resume=resume, clock=clock)
        self.config, self.adviser = config, Adviser(config)
        self.history = History.read(resume) if resume else History()
        self.history.reward_scale = config.reward_scale
        self._take(next(self._run))

    @property
    def decisions(self) -> int:
        return int(self.history["decisions"][-1]) if len(self.history) else 0

    @property
    def landed(self) -> float:
        return RecentCurves(self.history, self.config).last("success")

    def send(self, command: Any) -> None:
        self._take(self._run.send(command))

    def go_on(self) -> str:
        """Take one step; return the name of the hint that is shown."""
        if self._take(next(self._run)):
            self.adviser.advise(self.history, self.config)
        return self.adviser.shown.name if self.adviser.shown else ""

    def _take(self, messages: tuple[Any, ...]) -> bool:
        news = [message for message in messages if isinstance(message, Point | SettingChange | Checkpoint)]
        for message in news:
            self.history.append(message)
            if isinstance(message, SettingChange) and hasattr(self.config, message.name):
                self.config = self.config.turned(message.name, message.after)
        return bool(news)

    def close(self) -> None:
        self._run.close()


TRIED = json.loads(Path(__file__).with_name("remedies.json").read_text())


@pytest.fixture(scope="module")
def landing(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder: Path = tmp_path_factory.mktemp("run") / "lands"
    run = Watched(NEAR, keep=folder)
    while run.decisions < HEALTHY:
        run.go_on()
    assert run.landed > 0.7
    run.close()
    return folder


@pytest.fixture
def run(landing: Path) -> Iterator[Watched]:
    run = Watched(NEAR, landing)
    yield run
    run.close()


def hint_after(run: Watched, decisions: int = 60_000) -> str:
    end = run.decisions + decisions
    while run.decisions < end:
        if hint := run.go_on():
            return hint
    return ""


def said(run: Watched, chart: str, shown: str = "") -> str:
    found = caption(chart, RecentCurves(run.history, run.config), shown=shown)
    return found.name if found else ""


def test_all_at_random_is_put_back_and_it_lands_again(run: Watched):
    run.send(("change", "epsilon_end", 1.0))
    assert hint_after(run) == "changed"
    assert run.adviser.shown
    assert dict(run.adviser.shown.remedy) == {"epsilon_end": 0.05}
    assert run.adviser.shown.back_to is None
    assert run.landed < 0.3
    assert said(run, "epsilon") == "all"
    run.adviser.apply()
    run.send(("change", "epsilon_end", 0.05))
    assert hint_after(run, 24_000) == "", "it is on its way back"
    assert run.landed > 0.7


def test_an_edited_network_goes_back_to_before_the_edit(run: Watched):
    for unit in range(NEAR.hidden[-1]):
        run.send(("edit", Edit(1, unit)))
    assert hint_after(run) == "edited"
    for shown in ("", "steady", "falls", "rises"):
        assert said(run, "loss", shown) == "held", "it has learnt, and does not now: the number is an old one"
    assert run.adviser.shown
    assert run.adviser.shown.back_to is not None
    run.send(("restore", run.adviser.shown.back_to))
    run.adviser.apply(went_back=True)
    assert hint_after(run, 16_000) == ""
    assert run.landed > 0.7
    assert said(run, "loss") not in ("", "held", "waits", "unknown")


def test_what_was_undone_is_not_blamed(run: Watched):
    run.send(("edit", Edit(1, 0)))
    run.send(("undo", True))
    run.send(("change", "discount", 0.9))
    run.send(("change", "discount", NEAR.discount))
    run.send(("learn_on",))
    assert hint_after(run, 5_000) == ""
    assert RecentCurves(run.history, run.config).blamed() == []


def test_only_what_brought_a_run_back_is_offered(subtests: pytest.Subtests):
    """`benchmarks.remedies` has tried every one."""
    pressed = {rule.partition(" ")[0] for each in TRIED.values() for rule in each["pressed"]}
    run = RecentCurves(recorded("modern healthy").history, PRESETS["classic"].changed(epsilon_end=0.5, tau=1e-4))
    offers = {rule.name for rule in RULES if rule.remedy(run) or rule.name in ("changed", "rate_too_high", "crashes")}
    assert offers <= pressed, "a remedy was never tried"
    for name, tried in TRIED.items():
        with subtests.test(name=name):
            assert tried["pressed"]
            assert tried["after"] > max(0.5, tried["with"] + 0.25)
            assert tried["left alone"] is None or tried["after"] > tried["left alone"] + 0.25
