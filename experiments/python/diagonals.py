"""A planner with nothing but numpy: parallel lines at 45 degrees, every other one turned round."""

import numpy as np

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
    """Lines at 45 degrees through (0, 0), so that they meet from layer to layer."""

    name = "diagonals"
    role = "fill"
    summary = "parallel lines at 45 degrees"
    source = "an example"

    end_gap = Real(1.0, 0.5, 3.0, unit="line widths", help="between a line's end and the wall")
    turn = Bool(True, help="lay every other line backwards")

    def plan(self, layer, context):
        """Lines of one polygon after those of another, in the order in which they lie."""
        gap = self.end_gap * context.line_width_mm
        step = context.line_distance_mm
        for polygon in layer.polygons:
            across = polygon.outer @ ACROSS
            first = int(np.ceil((across.min() + gap) / step))
            last = int(np.floor((across.max() - gap) / step))
            for k in range(first, last + 1):
                places = crossings(polygon, k * step)
                lines = [
                    np.array([enter + gap, leave - gap])[:, None] * ALONG + k * step * ACROSS
                    for enter, leave in zip(places[::2], places[1::2])
                    if leave - enter > 3 * gap
                ]
                yield from (line[::-1] for line in lines[::-1]) if self.turn and k % 2 else lines
