"""Two-dimensional rigid bodies on NumPy, in batches of independent worlds.

Reading order: `vector`, `shapes`, `state`, `integrate`, `collide`, `broad_phase`, `contact_set`, `solver`, `rest`,
`contacts`, `world`, `body`, `sprite`.

    from engine import Circle, Polygon, World

    world = World(gravity=(0.0, -9.81))
    world.add(Polygon.box(20.0, 1.0), (0.0, -0.5), static=True)
    ball = world.add(Circle(0.5), (0.0, 4.0), mass=1.0, restitution=0.8)
    for _ in range(60):
        world.step()
    print(ball.position)        # (batch, 2)

`free_flight` flies one body of one world in plain floats, as long as it touches nothing.
"""

from engine.body import Body
from engine.collide import Manifold, collide
from engine.free_flight import FreeFlight
from engine.shapes import Circle, Polygon, Shape
from engine.sprite import Sprite
from engine.world import DT, World

__all__ = ["DT", "Body", "Circle", "FreeFlight", "Manifold", "Polygon", "Shape", "Sprite", "World", "collide"]
