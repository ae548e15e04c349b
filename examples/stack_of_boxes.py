"""Drop a stack of boxes on the moon, and print how high the topmost one stands until all are at rest."""

from engine import DT, Polygon, World

world = World(gravity=(0.0, -1.62))
world.add(Polygon.box(20.0, 1.0), (0.0, -0.5), mass=1.0, static=True)
boxes = [world.add(Polygon.box(1.0, 1.0), (0.05 * n, 0.6 + 1.1 * n), mass=1.0, friction=0.6) for n in range(5)]

if __name__ == "__main__":
    for step in range(601):
        if step % 60 == 0:
            x, y = boxes[-1].position[0]
            print(f"{step * DT:4.1f} s   {y:5.2f} m high, {x:+.2f} m aside")
        world.step()
