"""@NAME@: rings inside one another. Put your own idea into plan(); the rest can stay."""

import numpy as np

from routebench import nearest_first, offset
from routebench.planner import Planner, Real


class @CLASS@(Planner):
    """Found by its `name` when the file is loaded."""

    name = "@NAME@"
    role = "fill"
    summary = "rings inside one another"
    source = "your name, year"

    # Each parameter is declared in one line: configs, --set, help and the record come from that.
    pitch = Real(1.0, 0.5, 2.0, unit="line distances", help="between one ring and the next")

    def plan(self, layer, context):
        """Strokes as arrays of shape (n, 2), mm, in the order in which they are laid.

        Equal arguments must give equal strokes, and beads must stay inside the layer's polygons.
        `routebench check-planner` tells.
        """
        loops = []
        region = offset(layer.polygons, -context.line_width_mm / 2)
        while region:
            for polygon in region:
                for ring in polygon.rings:
                    loops.append(np.vstack([ring, ring[:1]]))  # a loop repeats its first point
            region = offset(region, -self.pitch * context.line_distance_mm)
        return nearest_first(loops, context.start)
