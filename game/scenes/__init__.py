"""The screens of the game, a folder or a file each. A scene names the next one by a route, and imports none of them.

Dialogs and what lies behind the menu are parts of scenes, imported by those that show them.
"""

from importlib import import_module
from typing import Final

from game.core.scene import Route, Scene
from game.ui.context import Context

# The name of each scene that another may lead to: the module in this package, and the class in that.
ROUTES: Final = {
    "menu": "menus.menu.MenuScene", "flights": "menus.menu.FlightsScene", "play": "play.scene.PlayScene",
    "tutorial": "play.starts.tutorial", "descent": "play.starts.descent", "race": "play.starts.race",
    "fly_on": "play.starts.fly_on", "missions": "play.missions.MissionsScene", "day": "play.starts.day",
    "watch": "watch.scene.WatchScene",
    "train": "train.scene.TrainScene", "taste": "taste.scene.TasteScene", "runs": "networks.scene.NetworksScene",
    "digits": "digits.scene.DigitsScene", "digit_training": "train.digits.digit_training",
    "digit_inside": "digits.inside.DigitInsideScene",
    "physics": "physics.scene.PhysicsScene", "physics_step": "physics.step_scene.PhysicsStepScene",
    "logbook": "logbook.scene.LogbookScene", "replay": "logbook.replay.ReplayScene",
    "settings": "menus.settings.SettingsScene", "bindings": "menus.keys.BindingsScene",
    "pause": "play.pause.PauseScene",
    "flight_pause": "play.pause.FlightPauseScene", "learn": "learn.list.LearnScene",
    "one_file": "learn.one_file.OneFileScene", "chapter": "learn.scene.ChapterScene",
    "lesson": "lesson.scene.LessonScene",
    "error_screen": "error_screen.ErrorScene",
}  # fmt: skip


def scene_of(route: Route, context: Context) -> Scene:
    """Build the scene that a route names; its module is loaded when it is first needed."""
    module, _, name = ROUTES[route.name].rpartition(".")
    scene: Scene = getattr(import_module(f"{__name__}.{module}"), name)(context, *route.arguments, **route.options)
    return scene
