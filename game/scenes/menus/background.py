"""Menu background: the moon, and a lander that the network lands again and again."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import cycle, repeat
from threading import Thread
from typing import Final

import numpy as np
import numpy.typing as npt

from ai.lander.environment import LanderEnv, Outcome
from game.drawing.canvas import Canvas
from game.flight.flight import Poses
from game.flight.networks import Policy, decision_steps
from game.ui.context import Context
from game.world.camera import Camera, CameraTarget
from game.world.craft import STAND
from game.world.landscape.backdrop import landscape
from game.world.landscape.ground import draw_ground
from game.world.stage import Stage

_ASIDE: Final = CameraTarget(-8.0)  # the words are on the left, so the pad is on the right
_EARTH: Final = (824.0, 168.0)
_REST_STEPS: Final = 110  # between a landing and the next ascent
_CLIMB: Final = 3.2  # m/s
_HIGH: Final = 7.5  # metres up to which it burns in an ascent, to coast from there until it falls
_LEANS: Final = (0.30, -0.16, 0.08, -0.24, 0.18)  # radians, one for each ascent
_SLACK: Final = 0.04  # tolerance of an ascent's angle, in radians
_LEFT, _RIGHT, _MAIN = 1, 2, 3
LOADER: Final = "menu-network"  # name of the thread that loads it


class MenuBackground:
    """Background of the menu; while `still`, the lander stands on its pad and nothing moves.

    Attributes:
        env, poses, stage: the lander, and what is drawn of it.
        pilot: flies it down; None until its network is loaded.

    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self.still = context.settings.reduced_motion
        self._camera = Camera()
        self._camera.cut(_ASIDE)
        self.env = LanderEnv(1, 0, frame_skip=1)
        self.env.reset()
        self.pilot: Policy | None = None
        self._step = 0
        self._begin()
        # The first ascent needs none.
        Thread(target=self._load_network, name=LOADER, daemon=True).start()

    def enter(self) -> None:
        self.still = self._context.settings.reduced_motion
        if self.still:
            self._begin()

    def _load_network(self) -> None:
        from ai.lander.pilots import ScriptedPilot
        from ai.lander.route import sink_of
        from game.flight import networks

        context = self._context
        with networks.kept.lock:  # what is read and measured here is kept, and the next scene need not wait for it
            policy = networks.chosen(context.models_dir, context.user_dir, context.settings.model).policy
            if isinstance(policy, networks.QPolicy):
                sink_of(policy)  # type: ignore[arg-type]  # one network is one object
        self.pilot = policy or ScriptedPilot()

    def update(self) -> None:
        if self.still:
            return
        self._step += 1
        was_over = self.over
        if (action := next(self._actions)) is not None:
            self.env.fly(action)
        self.poses.take()
        self.stage.follow(np.ones(1, bool), np.array([self.over and not was_over]))

    def draw(self, canvas: Canvas, alpha: float) -> None:
        view = self._camera.view(canvas.scale).filling(canvas)
        landscape(canvas.surface.get_size(), "moon").draw(canvas, self._camera, earth=_EARTH)
        draw_ground(canvas, view, self.env.ground)
        self.stage.draw_lander(canvas, view, self.poses.at(alpha)[0])
        self.stage.particles.draw(canvas.surface, view, alpha)

    @property
    def over(self) -> bool:
        return bool(self.env.outcome[0] != Outcome.FLYING)

    def _begin(self) -> None:
        self._stand(self.env.pad[0, 0])
        self._actions = self._flights()
        self.poses, self.stage = Poses(self.env), Stage(self.env, np.random.default_rng(0))
        self.stage.blue[:] = 1.0

    def _stand(self, x: float) -> None:
        self.env.place(np.ones(1, bool), np.array([[x, self.env.pad[0, 1] + STAND, 0.0, 0.0, 0.0, 0.0]]))

    def _flights(self) -> Iterator[npt.NDArray[np.intp] | None]:
        """Yield the action of each step: of an ascent until it falls, then of the pilot; None while it rests."""
        env = self.env
        for lean in cycle(_LEANS):
            while self.pilot is None or env.position[0, 1] <= _HIGH or env.velocity[0, 1] >= 0:
                yield np.array([self._ascend(lean)])
            while not self.over:
                action = self.pilot.act(env.observe(), held=env.actions)
                for _ in range(decision_steps(self.pilot)):
                    if not self.over:
                        yield action
            yield from repeat(None, _REST_STEPS)
            self._stand(env.position[0, 0] if env.outcome[0] == Outcome.LANDED else env.pad[0, 0])

    def _ascend(self, lean: float) -> int:
        """Return the ascent's action: lean to a side, and fire only below a limit of speed, to stay in view."""
        env = self.env
        off = lean - float(env.angle[0]) - 0.9 * float(env.angular_velocity[0])
        steer = _LEFT if off > _SLACK else _RIGHT if off < -_SLACK else 0
        return steer + _MAIN * bool(env.velocity[0, 1] < _CLIMB and env.position[0, 1] < _HIGH)
