"""What flies in Watch: a swarm with its camera, fire, trails and sound, and the player's hand on one of its landers."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from ai.environment import Bools, Doubles
from ai.lander.environment import LanderEnv, Outcome
from game.audio.flight_sounds import FlightSound
from game.core import texts
from game.core.clock import TimeScale
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import INK
from game.flight.networks import Policy
from game.flight.swarm import REST_STEPS, Swarm
from game.scenes.watch.policy_map import PolicyMap
from game.ui.context import Context
from game.ui.playback import Playback
from game.world import framing
from game.world.camera import Camera, CameraTarget, ClearArea, View
from game.world.craft import draw_crowd
from game.world.landscape.backdrop import EARTH, EARTH_RADIUS, landscape
from game.world.landscape.pad import draw_pad
from game.world.paths import Trails
from game.world.scenery import mark_lost
from game.world.stage import Stage

SPEEDS: Final = (0.25, 1.0, 4.0)
MANY: Final = 64  # landers, if there is more than one
_SMALL: Final = 0.46  # size of each of many, to be seen through
_SKY: Final = (-17.0, 17.0, 17.0)  # metres from left to right and up, that a camera at rest shows
_CLICK_REACH: Final = 1.6  # metres
_WRECK_STEPS: Final = 8  # steps a wreck of a swarm stays to be seen


class Watched:
    """Landers that one network flies, all drawn in one world.

    Attributes:
        swarm: the landers.
        camera, stage, trails: what is drawn of them.
        shown: number of the lander whose decisions are shown.
        playback: the clock; while it is stopped, the shown lander can be touched.
        policy_map: colours of the sky.
        free: what words leave free of the window, in points.

    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self.policy_map = PolicyMap()
        self._clock = TimeScale()
        self.playback = Playback(self._clock, SPEEDS, self.fly_to_the_next_decision)
        self.shown = 0
        self.free = context.reading().view

    def begin(self, many: bool, seed: int, policy: Policy) -> None:
        count = MANY if many else 1
        self.swarm = Swarm(count, seed, policy)
        self.stage = Stage(self.swarm.env, np.random.default_rng(seed))
        self.stage.blue[:] = 1.0
        self._heard = FlightSound(self._context.sound, self.swarm.env, warns=False)
        self.trails = Trails(count, keep=5 if many else 0)
        self.shown = min(self.shown, count - 1)
        self.policy_map.forget()
        self.set_up_camera()
        self._clock.begin()

    @property
    def env(self) -> LanderEnv:
        return self.swarm.env

    @property
    def many(self) -> bool:
        return self.env.num_envs > 1

    @property
    def size(self) -> float:
        """Size at which the shown lander is drawn; 1 is true to scale."""
        return 1.5 * _SMALL if self.many else 1.0

    def set_up_camera(self) -> None:
        """Let the camera follow a single lander; with several, a map or reduced motion it rests on the whole sky."""
        self.camera, self.stage.calm = Camera(), self._context.settings.reduced_motion
        sky = CameraTarget.around(*_SKY, self.clear)
        self.camera.cut(framing.framed(self.env, clear=self.clear) if self._follows else sky)

    @property
    def _follows(self) -> bool:
        return not (self.many or self.stage.calm or self.policy_map.on)

    # Steps

    def update(self) -> None:
        """Fly as many steps as the chosen speed makes due, and follow with all that moves besides."""
        for _ in range(self.playback.steps()):
            self.fly()
        if not self.playback.stopped:
            self._heard.follow(self.stage.thrust[self.shown], self.shown)
        self.policy_map.follow(self.env, self.shown, self.swarm.policy)

    def fly(self) -> None:
        swarm = self.swarm
        ended = swarm.step()
        self.stage.follow(np.ones(swarm.env.num_envs, bool), ended)
        self.trails.follow(swarm.env.position, swarm.env.outcome, swarm.fresh, ended)
        if self._follows:
            framing.follow(self.camera, swarm.env, clear=self.clear)

    def fly_to_the_next_decision(self) -> None:
        """Fly until the shown lander's next decision, through its rest after a flight."""
        before = self.swarm.decided[self.shown]
        for _ in range(REST_STEPS + self.swarm.decision_steps):
            self.fly()
            if self.swarm.decided[self.shown] != before:
                return

    def nearest(self, point: tuple[float, float]) -> int | None:
        """Return the lander nearest to a point of the canvas; None if none is close."""
        distance = np.hypot(*(self.env.position - self.metres(point)).T)
        slot = int(distance.argmin())
        return slot if distance[slot] <= _CLICK_REACH else None

    # The hand

    @property
    def touched(self) -> bool:
        return bool(self.swarm.touched[self.shown])

    @property
    def state(self) -> Doubles:
        """State of the shown lander, (6,): x, y, vx, vy, angle, spin."""
        env, slot = self.env, self.shown
        return np.array([*env.position[slot], *env.velocity[slot], env.angle[slot], env.angular_velocity[slot]])

    @property
    def tilt_words(self) -> str:
        return texts.TOUCH_TILT.format(tilt=math.degrees(float(self.env.tilt[self.shown])))

    # Where it is, in points

    @property
    def clear(self) -> ClearArea:
        """The part of the world that is kept clear for what flies."""
        return ClearArea.of(self._context.reading(), self.free)

    def _world(self, canvas: Canvas) -> Canvas:
        return canvas.above(canvas.view.bottom - self.free.bottom)

    def _view(self, world: Canvas, between: float = 1.0) -> View:
        return self.camera.view(world.scale, between).filling(world)

    def place(self, position: Doubles) -> Point:
        """Return where a place of the world, in metres, is seen."""
        canvas = self._context.reading()
        return canvas.points(self._view(self._world(canvas)).pixel(*position.tolist()))

    def metres(self, point: Point) -> Doubles:
        """Return the place of the world that is seen at a point."""
        canvas = self._context.reading()
        world = self._world(canvas)
        return self._view(world).metres(world.points(canvas.pixels(point)))

    @property
    def points_per_metre(self) -> float:
        canvas = self._context.reading()
        return self._view(self._world(canvas)).pixels_per_metre / canvas.scale

    def touch(self, start: Doubles) -> None:
        """Let the shown lander fly on from another state: x, y, vx, vy, angle, spin; it leaves its traces behind."""
        swarm, slot = self.swarm, self.shown
        swarm.touch(slot, start)
        self.stage.forget()
        self.trails.begin(slot)
        action = int(swarm.decision.action[slot])
        self.stage.thrust[slot] = action >= 3, action % 3 == 2, action % 3 == 1

    # The picture

    def draw(self, canvas: Canvas, between: float) -> None:
        canvas = self._world(canvas)
        view, size = self._view(canvas, between), _SMALL if self.many else 1.0
        earth = self.clear.earth(EARTH, EARTH_RADIUS)
        landscape(canvas.surface.get_size(), "moon").draw(canvas, self.camera, between, earth)
        self.policy_map.draw(canvas, view)
        env, poses = self.env, self.swarm.poses.at(between)
        others = self._others()
        self.stage.draw_fires(canvas, view, poses, others, size)  # the pad hides what reaches below it
        draw_pad(canvas, view, (float(env.pad[0, 0]), float(env.pad[0, 1])), float(env.pad_width[0]))
        self.trails.draw(canvas, view, self.shown, self.clear.head)
        draw_crowd(canvas, view, poses[others], size)
        self._draw_shown(canvas, view, poses[self.shown])
        self.stage.particles.draw(canvas.surface, view, between)

    def _others(self) -> Bools:
        """Which landers are drawn beside the one that is shown, (n,): all but those long wrecked."""
        others: Bools = (self.swarm.since_end <= _WRECK_STEPS) | (self.env.outcome == Outcome.LANDED)
        others[self.shown] = False
        return others

    def _draw_shown(self, canvas: Canvas, view: View, pose: Doubles) -> None:
        if self.env.outcome[self.shown] == Outcome.OUT_OF_BOUNDS:
            mark_lost(canvas, view, pose)
            return
        self.stage.draw_lander(canvas, view, pose, self.shown, self.size)
        if self.many and not self.playback.stopped:
            x, y = view.points(pose[:2]).tolist()
            canvas.marker("triangle_down", (x, y - 46 * self.size - 10), 9, INK)
