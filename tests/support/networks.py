"""Places on a network that is drawn."""

from game.drawing.canvas import Point
from game.explain.network_view import NetworkView
from game.scenes.train.editing import Link, part_at


def on_a_link(view: NetworkView, layer: int = 0) -> Point:
    """A place on a drawn link of a layer at which that link is meant."""
    for edge in reversed(view.edges):
        (x0, y0), (x1, y1) = view.centres[edge.column][edge.start], view.centres[edge.column + 1][edge.end]
        for share in (0.5, 0.3, 0.7):
            place = (round(x0 + share * (x1 - x0)), round(y0 + share * (y1 - y0)))
            if edge.column == layer and isinstance(part_at(view, place), Link):
                return place
    raise AssertionError("no link is drawn")
