"""Everything that moves in front of the landscape: landers, their flames and light, shadows, dust."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from functools import lru_cache
from typing import Final

import numpy as np
import pygame

from ai.environment import Bools, Doubles
from ai.lander.environment import LanderEnv, Outcome
from engine import Sprite
from game.drawing.canvas import Canvas
from game.drawing.paint import light, mix
from game.drawing.tokens import HUMAN, NET, Colour
from game.flight.foresight import surface_height
from game.world import lander as art
from game.world.camera import View
from game.world.craft import STAND, draw_craft, draw_fires, foot_place, scaling, shaded, stand
from game.world.landscape.wind import Wind
from game.world.particles import DUST, Particles
from game.world.wreck import Wreck

_IGNITE: Final = 0.34  # share of the way to full or no thrust that a flame covers per step
_DIE: Final = 0.22
_DUST_HEIGHT: Final = 6.0
_LIGHT_HEIGHT: Final = 9.0
_FLASH_STEPS: Final = 24
_JOLT: Final = 11.0  # points, of the hardest blow
_WRECK_DETAIL: Final = 0.6  # resolution of a wreck, of what the closest view would need


def flames(env: LanderEnv) -> Doubles:
    """Return the thrust of each nozzle, 0 to 1: main engine, left-hand jet, right-hand jet, (n, 3)."""
    main, side = env.thrust.T
    return np.stack([main, np.maximum(side, 0.0), np.maximum(-side, 0.0)], axis=1)


class Stage:
    """The flames, dust and light around the landers of one environment; call `follow` once after every step.

    `dust` is the colour of dust, `light` the ambient light on the craft, 0 to 1, without that of their flames.

    Attributes:
        calm: whether motion is reduced.
        jolt: camera shake caused by the last step, in points.
        wind: the flight's wind, which carries particles.

    """

    def __init__(
        self,
        env: LanderEnv,
        rng: np.random.Generator,
        reduced_motion: bool = False,
        dust: Colour = DUST,
        light: float = 1.0,
    ) -> None:
        self._env = env
        self._rng = rng
        self.calm, self._light = reduced_motion, light
        self.particles, self.wind = Particles(rng, env, dust), Wind(env, dust)
        count = env.num_envs
        self.thrust = np.zeros((count, 3))  # main engine, left-hand jet, right-hand jet
        self.blue = np.zeros(count)  # 0 while a person flies, 1 while a network does, in between during a handover
        self.flash = np.zeros(count, np.intp)
        self.jolt = 0.0
        self._lander = Sprite(env.lander, art.LANDER, art.SIZE)
        self._after: Wreck | None = None
        self._flicker = 0
        self._down = np.zeros(2, bool)
        self._fall = 0.0

    def follow(self, networks: Bools, ended: Bools) -> None:
        """Ease all effects towards the environment's state.

        `networks` (n,) is whether a network flies each lander, `ended` (n,) whether its flight just ended.
        """
        env = self._env
        flying = env.outcome == Outcome.FLYING
        wanted = flames(env) * flying[:, None]
        self.thrust += np.where(wanted > self.thrust, _IGNITE, _DIE) * (wanted - self.thrust)
        self.blue += (1.0 if self.calm else 0.14) * (networks - self.blue)
        self._flicker += 1
        self.flash = np.maximum(self.flash - 1, 0)
        self.jolt = 0.0
        for slot in np.flatnonzero(ended & self._wrecked):
            self.flash[slot] = _FLASH_STEPS
            self.particles.burst(env.position[slot], env.velocity[slot], 1.0 if env.num_envs == 1 else 0.2)
        if env.num_envs == 1:
            self._follow_one(bool(ended[0]))
        self.wind.follow()
        self.particles.wind = self.wind.speed
        self.particles.update()

    def forget(self) -> None:
        """Remove the traces of the last steps, because another moment is shown."""
        self.flash[:] = 0
        self.particles.clear()
        self.wind.forget()
        self._after = None
        self._down, self._fall = self._env.feet_down[0].copy(), 0.0

    def pose_after(self, alpha: float) -> Doubles | None:
        """Return the pose (x, y, angle) of what still moves after the end; None where nothing does."""
        return None if self._after is None else self._after.pose(alpha)

    @property
    def _wrecked(self) -> Bools:
        """Whether each flight ended in a wreck, (n,)."""
        wrecked: Bools = (self._env.outcome == Outcome.CRASHED) & ~self._env.intact
        return wrecked

    def _follow_one(self, ended: bool) -> None:
        """Update the close-up effects of a single lander: exhaust, dust, touchdown, crash."""
        env = self._env
        if ended:
            self._after = self._begin_after()
        elif env.outcome[0] == Outcome.FLYING:
            self._after = None  # in Watch, the next flight begins in the same slot
        if self._after is not None:
            self._after.step()
        elif env.outcome[0] != Outcome.CRASHED:
            self._burn()
            self._touch()

    def _begin_after(self) -> Wreck | None:
        """Return what still moves after the end; with reduced motion, no wreck tumbles."""
        env = self._env
        if env.outcome[0] != Outcome.CRASHED:
            return None
        if env.intact[0]:
            strength = min(1.0, float(env.impact[0, 0]) / env.limits.touch_speed)
            self._thud((0, 1), strength)
            return Wreck(env, 0, self._rng)
        self.jolt = min(_JOLT, 4.0 + 1.4 * float(env.impact[0, :2].max()))
        return None if self.calm else Wreck(env, 0, self._rng)

    def _burn(self) -> None:
        env = self._env
        x, y = env.position[0].tolist()
        angle, thrust = float(env.angle[0]), float(self.thrust[0, 0])
        if thrust < 0.05:
            return
        down = np.array([math.sin(angle), -math.cos(angle)])
        self.particles.burn(env.position[0] - art.NOZZLE[1] * down, down, env.velocity[0], thrust, float(self.blue[0]))
        reach = y - surface_height(env, x)
        if reach < _DUST_HEIGHT and abs(angle) < 1.2:
            aim = x + math.tan(angle) * reach
            self.particles.blow(aim, thrust * (1 - reach / _DUST_HEIGHT) ** 1.5)

    def _touch(self) -> None:
        """Raise dust for each foot that comes down, more for a harder touchdown."""
        env, down = self._env, self._env.feet_down[0]
        strength = min(1.0, max(0.0, self._fall) / env.limits.touch_speed)
        self._thud(np.flatnonzero(down & ~self._down).tolist(), strength)
        self._down, self._fall = down.copy(), -float(env.velocity[0, 1])

    def _thud(self, feet: Iterable[int], strength: float) -> None:
        (x, y), angle = self._env.position[0].tolist(), float(self._env.angle[0])
        for foot in feet:
            self.particles.raise_dust(foot_place(x, y, angle, 2 * foot - 1), strength)
            self.jolt = max(self.jolt, _JOLT * 0.55 * strength**1.5)

    # One lander in full

    def sprite(self, slot: int = 0, size: float = 1.0) -> Sprite:
        """Return the sprite of a slot's lander; `size` 1 is true to scale."""
        sprite = self._after.sprite if self._after else self._lander
        image = art.WRECK if self._wrecked[slot] else art.LANDER
        return replace(sprite, image=image, size=(size * sprite.size[0], size * sprite.size[1]))

    def draw_lander(
        self, canvas: Canvas, view: View, pose: Doubles, slot: int = 0, size: float = 1.0, alpha: float = 1.0
    ) -> None:
        """Draw one lander with everything around it but dust; `size` 1 is true to scale."""
        sprite = self.sprite(slot, size)
        after = self.pose_after(alpha)
        pose = pose if after is None else after
        x, y, angle = pose.tolist()
        self._draw_shadow(canvas, view, x, y, angle)
        self._draw_ground_light(canvas, view, x, y, angle, slot)
        floor = view.pixel(x, surface_height(self._env, x))[1] + 2
        if sprite.image == art.WRECK:
            self._draw_wreck(canvas, view, sprite, pose)
        else:
            fire = self.thrust[slot], float(self.blue[slot]), self._flicker
            draw_craft(canvas, view, sprite.image, pose, *fire, art.share(sprite), floor, self._light)
        self._draw_flash(canvas, view, x, y, slot)

    def _draw_wreck(self, canvas: Canvas, view: View, sprite: Sprite, pose: Doubles) -> None:
        """Draw the dark wreck of a crash."""
        x, y, angle = pose.tolist()
        size = art.share(sprite)
        middle = view.pixel(*stand(x, y, angle, size))
        # A new picture for each degree that it tumbles, none of them seen from as near as a craft in flight.
        most = view.painted_per_metre * size
        detail = min(most, max(_WRECK_DETAIL * most, art.LARGE)) / most
        craft = art.turned(sprite.image, detail * most, angle, middle, scaling(view) / detail)
        canvas.surface.blit(shaded(craft[0], self._light), craft[1])

    # A swarm, small and in one call, each standing on its feet; `shown` is a mask (n,)

    def draw_fires(self, canvas: Canvas, view: View, poses: Doubles, shown: Bools, size: float) -> None:
        """Draw the flames of those whose main engine burns."""
        draw_fires(canvas, view, poses[shown & (self.thrust[:, 0] > 0.25)], self._flicker, size)

    def _draw_shadow(self, canvas: Canvas, view: View, x: float, y: float, angle: float) -> None:
        metre = view.pixels_per_metre
        ground = surface_height(self._env, x)
        clearance = max(0.0, y - STAND - ground)
        level = round(8 * max(0.0, 1 - clearance / 7) ** 1.6)
        if level:
            across = (1.25 + 0.10 * clearance) * metre
            shadow = pygame.transform.smoothscale(_shade(level), (2 * round(across), 2 * round(0.15 * metre)))
            _blit_middle(canvas, shadow, view, (x, ground + 0.03))
        for side in (-1, 1):
            foot_x, foot_y = foot_place(x, y, angle, side)
            under = surface_height(self._env, foot_x)
            near = round(8 * max(0.0, 1 - max(0.0, foot_y - under) / 0.6))
            if near:
                size = (2 * round(0.34 * metre), 2 * max(2, round(0.075 * metre)))
                spot = pygame.transform.smoothscale(_shade(near), size)
                _blit_middle(canvas, spot, view, (foot_x, under + 0.02))

    def _draw_ground_light(self, canvas: Canvas, view: View, x: float, y: float, angle: float, slot: int) -> None:
        thrust = float(self.thrust[slot, 0])
        reach = max(0.0, y - surface_height(self._env, x))
        if thrust < 0.05 or reach > _LIGHT_HEIGHT or abs(angle) > 1.2:
            return
        aim = x + math.tan(angle) * reach * 0.8
        level = round(12 * thrust * (1 - reach / _LIGHT_HEIGHT) ** 1.8)
        if level:
            colour = mix(HUMAN, NET, round(float(self.blue[slot]) * 4) / 4)
            metre = view.pixels_per_metre
            size = (2 * round((2.0 + 0.25 * reach) * metre), 2 * round(0.42 * metre))
            pool = pygame.transform.smoothscale(_light_pool(level, colour), size)
            _blit_middle(canvas, pool, view, (aim, surface_height(self._env, aim) - 0.02), pygame.BLEND_RGB_ADD)

    def _draw_flash(self, canvas: Canvas, view: View, x: float, y: float, slot: int) -> None:
        left = math.ceil(12 * self.flash[slot] / _FLASH_STEPS) / 12  # in steps, so that few glows are ever made
        if left > 0 and not self.calm:
            metre = view.pixels_per_metre / view.scale
            canvas.glow(view.point(x, y), 4.6 * metre, (255, 176, 104), 0.8 * left**2)
            canvas.glow(view.point(x, y), 1.7 * metre, (255, 226, 190), 1.0 * left**3)


def _blit_middle(
    canvas: Canvas, sprite: pygame.Surface, view: View, position: tuple[float, float], flags: int = 0
) -> None:
    x, y = view.pixel(*position)
    corner = (round(x) - sprite.get_width() // 2, round(y) - sprite.get_height() // 2)
    canvas.surface.blit(sprite, corner, special_flags=flags)


@lru_cache(maxsize=16)
def _shade(level: int) -> pygame.Surface:
    """Return a soft dark disc, to be squeezed into a shadow; `level` is in 1/8."""
    axis = np.linspace(-1, 1, 97)
    cover = np.clip(1 - np.hypot(axis[:, None], axis[None, :]), 0, 1) ** 0.8 * 200 * level / 8
    surface = pygame.Surface(cover.shape, pygame.SRCALPHA)
    surface.fill((4, 5, 12, 0))
    pygame.surfarray.pixels_alpha(surface)[:] = cover.astype(np.uint8)
    return surface


@lru_cache(maxsize=128)
def _light_pool(level: int, colour: Colour) -> pygame.Surface:
    """Return a disc of light, to be squeezed flat and added; `level` is in 1/12."""
    axis = np.linspace(-1, 1, 97)
    away = np.clip(1 - np.hypot(axis[None, :], axis[:, None]), 0, 1)[..., None]
    return light((0.34 * away**2 + 0.42 * away**6) * np.array(colour) * level / 12)
