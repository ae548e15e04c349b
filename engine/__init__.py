"""Two-dimensional rigid bodies on NumPy, in batches of independent worlds.

Reading order: `vector`, `state`, `shapes`, `integrate`, `broad_phase`, `collide`, `contacts`, `constraints`, `solver`,
`rest`, `body`, `world`.

    from engine import Circle, Polygon, World

    world = World(gravity=(0.0, -9.81))
    world.add(Polygon.box(20.0, 1.0), (0.0, -0.5), static=True)
    ball = world.add(Circle(0.5), (0.0, 4.0), mass=1.0, restitution=0.8)
    for _ in range(60):
        world.step()
    print(ball.position)        # (batch, 2)
"""

from engine.body import Body, Sprite
from engine.collide import Manifold, collide
from engine.shapes import Circle, Polygon, Shape
from engine.world import DT, World, memory_of_worlds

__all__ = ["DT", "Body", "Circle", "Manifold", "Polygon", "Shape", "Sprite", "World", "collide", "memory_of_worlds"]
