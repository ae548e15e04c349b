"""Path preview: dotted paths ahead of a flight, without input and as a network would fly it."""

from __future__ import annotations

from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, NET
from game.flight.flight import Flight
from game.flight.forecast import Drift, Forecast
from game.flight.foresight import SixFutures
from game.flight.networks import Policy
from game.world.camera import View
from game.world.paths import draw_dotted, draw_faint

# After how many seconds of coasting a guardian asks for a landing, and whether there is one.
Coasting = tuple[float, bool]


class PathPreview:
    """Path preview of one flight; call `follow` once after every step, and while the craft waits.

    Attributes:
        drift: where the craft goes if nothing is done.
        forecast: where the network would fly it; None without a network.

    """

    def __init__(self, flight: Flight, network: Policy | None) -> None:
        self._flight = flight
        self.drift = Drift(flight.env)
        self._drifts = False
        self.ask(network)

    @property
    def asks(self) -> bool:
        """Whether a network's path is previewed too."""
        return self.forecast is not None

    def ask(self, network: Policy | None) -> None:
        """Preview this network's path from here on; with None, only the path without input."""
        self.forecast = Forecast(network, self._flight.env.ground) if network else None

    def follow(self, waiting: bool) -> None:
        """Extend both paths; the path without input stays the same while the craft hangs and waits."""
        if self._arrived:
            return
        self._drifts = not self._drifts and not waiting  # every other step, so that no frame has all of both
        if self._drifts:
            self.drift.follow()
        if self.forecast:
            self.forecast.follow(self._flight.env, 1 if self._drifts else 2)

    def draw(self, canvas: Canvas, view: View, head: float, coasting: Coasting | None = None) -> None:
        """Draw what is left of both paths, below the text in the uppermost `head` points.

        A mark on the path without thrust shows where a guardian's future of `coasting` ends.
        """
        if self._arrived:
            return
        draw_dotted(canvas, view, self.drift.path, HUMAN, head=head)
        if coasting:
            self._mark(canvas, view, head, *coasting)
        if self.forecast:
            draw_dotted(canvas, view, self.forecast.path, NET, head=head)

    def _mark(self, canvas: Canvas, view: View, head: float, seconds: float, lands: bool) -> None:
        place = view.points(self.drift.after(seconds)).tolist()
        if place[1] > canvas.view.top + head:
            canvas.marker("circle" if lands else "cross", place, 9, NET if lands else canvas.palette.warn)
            said = texts.EXPLAIN_COASTING_NOW["lands" if lands else "lost"].format(seconds=f"{seconds:.1f}")
            canvas.explain((place[0] - 8, place[1] - 8, 16, 16), texts.EXPLAIN_COASTING, lambda: said)

    @property
    def _arrived(self) -> bool:
        return self._flight.over or bool(self._flight.env.contacts[0].any())


def draw_futures(canvas: Canvas, view: View, futures: SixFutures, head: float) -> None:
    """Draw six futures as paths: blue to a landing, with a tick, or red to a cross."""
    for path, lands in zip(futures.paths, futures.lands, strict=False):
        colour = NET if lands else canvas.palette.warn
        draw_faint(canvas.surface, view.pixels(path), colour, 0.55 if lands else 0.45, canvas.scale * head)
        end = view.points(path[-1]).tolist()
        if end[1] > head:
            canvas.marker("check" if lands else "cross", end, 10, colour)
