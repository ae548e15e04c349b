"""Every scene of the game and how to get into it, with a player's folder in which there is something to be seen."""

from __future__ import annotations

import importlib
import pkgutil
import time
from collections.abc import Callable
from datetime import date
from functools import partial
from inspect import Parameter, isabstract, isclass, signature
from shutil import copytree

import game.scenes
from ai.digits.classifier import DigitClassifier
from ai.digits.preprocessing import preprocess_strokes
from ai.lander.missions import MISSIONS
from ai.lander.pilots import ScriptedPilot
from game.core.names import name_problem
from game.core.scene import Scene
from game.flight.days import Attempt, Days
from game.flight.flight import Flight
from game.flight.logbook import Records
from game.scenes.digits.dream import DreamScene
from game.scenes.digits.inside import DigitInsideScene
from game.scenes.digits.quiz import QuizScene
from game.scenes.digits.why_not import WhyNotScene
from game.scenes.learn.path import PATH
from game.scenes.learn.scene import ChapterScene
from game.scenes.lesson.scene import LessonScene
from game.scenes.logbook.replay import ReplayScene
from game.scenes.menus.dialogs import ListDialog, NameDialog, QuestionDialog
from game.scenes.physics.exhibits import EXHIBITS
from game.scenes.physics.scene import PhysicsScene
from game.scenes.physics.step_scene import PhysicsStepScene
from game.scenes.play.challenge import FlownMission
from game.scenes.play.daily import DailyStart
from game.scenes.play.descent import Descent
from game.scenes.play.scene import PlayScene
from game.scenes.play.starts import race
from game.scenes.watch.pilots import PilotsScene
from game.scenes.watch.scene import COUNTS, WatchScene
from game.ui.context import Context
from tests.support.lessons import lesson_of

FLIGHTS = 2


def scene_types() -> list[type[Scene]]:
    """Return the classes of all scenes there are, in the modules of `game.scenes`."""
    found = []
    for module in pkgutil.walk_packages(game.scenes.__path__, "game.scenes."):
        for each in vars(importlib.import_module(module.name)).values():
            here = isclass(each) and each.__module__ == module.name
            if here and not each.__name__.startswith("_") and issubclass(each, Scene) and not isabstract(each):
                found.append(each)
    return found


def stock(context: Context) -> None:
    """Put a few flights and a network of their own into the player's folder, as far as they are not there."""
    records = Records(context.user_dir)
    if not (days := Days(context.user_dir)).attempts:
        days.note(Attempt("2026-11-22", "LANDED", 84))
        days.note(Attempt("2026-11-20", "CRASHED"))
        days.note(Attempt("2026-11-17"))
    for seed in range(FLIGHTS - len(records.kept())):
        flight = Flight(seed, ScriptedPilot())
        flight.hand_over()
        while not flight.over:
            flight.step(0)
        records.keep(flight, time.time(), alone=True)
    own = context.user_dir / "models" / "mine"
    if not own.exists():
        copytree(context.models_dir / "lander" / "modern", own)


def makers(context: Context) -> dict[str, Callable[[], Scene | None]]:
    """Return what makes each scene that can be entered from outside; None if what it shows can't be read now."""
    rng = context.rng
    plain = {each.__name__: partial(each, context) for each in scene_types() if _needs_no_more(each)}
    missions = list(MISSIONS.values())

    def replayed(make: Callable[..., Scene]) -> Scene | None:
        records = Records(context.user_dir)
        files = sorted(records.kept())
        try:
            return make(context, records.read(files[rng.integers(len(files))])) if files else None
        except ValueError:
            return None

    def of_digits(make: Callable[..., Scene]) -> Scene | None:
        try:
            return make(
                context, DigitClassifier.load(context.models_dir / "digits" / str(rng.choice(["modern", "classic"])))
            )
        except (OSError, ValueError):
            return None

    return {
        **plain,
        "PilotsScene": lambda: PilotsScene(context, lambda file: None),
        "WatchScene": lambda: WatchScene(context, int(rng.choice(COUNTS))),
        "ChapterScene": lambda: ChapterScene(context, str(rng.choice(list(PATH)))),
        "PhysicsScene": lambda: PhysicsScene(context, str(rng.choice(list(EXHIBITS)))),
        "PhysicsStepScene": lambda: PhysicsStepScene(context, EXHIBITS[str(rng.choice(list(EXHIBITS)))](9.81)),
        "mission": lambda: PlayScene(context, 0, challenge=FlownMission(missions[rng.integers(len(missions))])),
        "daily": lambda: PlayScene(context, 1, challenge=DailyStart(date(2026, 1, 1), Days(context.user_dir))),
        "descent": lambda: PlayScene(context, 1, challenge=Descent()),
        "race": lambda: replayed(race),
        "LessonScene": lambda: LessonScene(context, lesson_of("modern")),
        "ReplayScene": lambda: replayed(ReplayScene),
        "DreamScene": lambda: of_digits(DreamScene),
        "QuizScene": lambda: of_digits(QuizScene),
        "DigitInsideScene": lambda: of_digits(partial(_of_a_digit, DigitInsideScene)),
        "WhyNotScene": lambda: of_digits(partial(_of_a_digit, WhyNotScene)),
    }


def _of_a_digit(make: Callable[..., Scene], context: Context, classifier: DigitClassifier) -> Scene:
    """Make a scene about a digit with a few strokes."""
    points = context.rng.random((4, 2)) * 400 + 50
    return make(context, classifier, preprocess_strokes([points]))


def dialogs(below: Scene) -> dict[str, Callable[[], Scene]]:
    """Return what makes each dialog over another scene; deep in scenes that train, they are seldom come by."""
    return {
        "QuestionDialog": lambda: QuestionDialog(below, "?", "", [("yes", lambda: None), ("no", lambda: None)]),
        "NameDialog": lambda: NameDialog(below, "?", "name", name_problem),
        "ListDialog": lambda: ListDialog(below, "?", [("a",), ("b",)], lambda _: None),
    }


def _needs_no_more(scene: type[Scene]) -> bool:
    """Whether a scene is built with the context alone."""
    _, *others = signature(scene).parameters.values()
    return all(
        each.default is not Parameter.empty or each.kind in (Parameter.VAR_POSITIONAL, Parameter.VAR_KEYWORD)
        for each in others
    )
