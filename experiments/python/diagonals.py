"""A planner with numpy: parallel lines at 45 degrees, every other one turned round."""

import numpy as np

from routebench import offset
from routebench.planner import Bool, Planner, Real

ALONG = np.array([1.0, 1.0]) / np.sqrt(2)
ACROSS = np.array([-1.0, 1.0]) / np.sqrt(2)


def crossings(polygon, height):
    """Places along a line at which it enters and leaves a polygon, sorted."""
    places = []
    for ring in polygon.rings:
        begin, end = ring, np.roll(ring, -1, axis=0)
        low, high = begin @ ACROSS - height, end @ ACROSS - height
        cut = (low <= 0) != (high <= 0)
        part = (low[cut] / (low[cut] - high[cut]))[:, None]
        places.extend((begin[cut] + part * (end[cut] - begin[cut])) @ ALONG)
    return np.sort(places)


class Diagonals(Planner):
    """Lines at 45 degrees through (0, 0); what must be dense gets a loop round them."""

    name = "diagonals"
    role = "fill"
    summary = "parallel lines at 45 degrees"
    source = "an example"

    lap = Real(0.35, 0.0, 1.0, unit="line widths", help="by which lines reach into the loop")
    turn = Bool(True, help="lay every other line backwards")

    def plan(self, layer, context):
        """Every loop first, then lines in the order in which they lie."""
        width, step = context.line_width_mm, context.line_distance_mm
        region = offset(layer.polygons, -width / 2)
        if context.density == 1:
            for polygon in region:
                for ring in polygon.rings:
                    yield np.vstack([ring, ring[:1]])
            region = offset(region, -(1 - self.lap) * width)
        for polygon in region:
            across = polygon.outer @ ACROSS
            for k in range(int(np.ceil(across.min() / step)), int(across.max() // step) + 1):
                places = crossings(polygon, k * step)
                lines = [
                    np.array([enter, leave])[:, None] * ALONG + k * step * ACROSS
                    for enter, leave in zip(places[::2], places[1::2])
                    if leave - enter > width / 2
                ]
                yield from (line[::-1] for line in lines[::-1]) if self.turn and k % 2 else lines
