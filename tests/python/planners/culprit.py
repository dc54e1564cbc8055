"""A planner in Python that hatches its layers, and misbehaves on layer 1 as it is told to."""

import os
import signal
import sys
import time

import numpy as np

from routebench.planner import Bool, Choice, Int, Planner, Real, Stroke


def hatch(layer, context):
    """Parallel lines with their ends pulled in."""
    half = context.line_width_mm / 2
    for polygon in layer.polygons:
        rings = [np.vstack([ring, ring[:1]]) for ring in polygon.rings]
        low, high = polygon.outer[:, 1].min() + half, polygon.outer[:, 1].max() - half
        step = context.line_distance_mm
        for k in range(int(np.ceil(low / step)), int(np.floor(high / step)) + 1):
            xs = []
            for ring in rings:
                a, b = ring[:-1], ring[1:]
                crossed = (a[:, 1] <= k * step) != (b[:, 1] <= k * step)
                part = (k * step - a[crossed, 1]) / (b[crossed, 1] - a[crossed, 1])
                xs.extend(a[crossed, 0] + part * (b[crossed, 0] - a[crossed, 0]))
            xs.sort()
            for left, right in zip(xs[::2], xs[1::2]):
                if right - left > 3 * half:
                    yield [[left + half, k * step], [right - half, k * step]]


class Culprit(Planner):
    """Does one thing wrong."""

    name = "py_culprit"
    role = "fill"
    summary = "misbehaves"
    source = "nobody, 2000"
    crime = Choice(
        [
            "none", "throw", "nan", "shape", "ragged", "words", "number", "width", "loop", "exit",
            "print", "chatter", "hoard", "kill", "sleep", "moody", "write", "thin",
        ],
        help="what to do",
    )
    share = Real(0.5, 0, 1, unit="mm", help="a number")
    count = Int(3, 1, 5, help="a whole number")
    flag = Bool(True, help="a truth")

    def plan(self, layer, context):
        strokes = list(hatch(layer, context))
        if layer.index != 1 or not strokes:
            return strokes
        return getattr(self, f"do_{self.crime}")(strokes, layer)

    def do_none(self, strokes, layer):
        return (stroke for stroke in strokes)

    def do_throw(self, strokes, layer):
        raise ValueError("no\nmood")

    def do_nan(self, strokes, layer):
        strokes[0][0][0] = float("nan")
        return strokes

    def do_shape(self, strokes, layer):
        return [np.zeros((4, 3))]

    def do_ragged(self, strokes, layer):
        return [[[0, 0], [1]]]

    def do_words(self, strokes, layer):
        return "strokes"

    def do_number(self, strokes, layer):
        return 7

    def do_width(self, strokes, layer):
        return [Stroke(strokes[0], width_mm="wide")]

    def do_loop(self, strokes, layer):
        while True:
            pass

    def do_exit(self, strokes, layer):
        sys.exit(3)

    def do_print(self, strokes, layer):
        print('{"strokes": []}')
        os.write(1, b"rubbish\n")
        return strokes

    def do_chatter(self, strokes, layer):
        for i in range(10_000):
            print("la la la", i)
        return strokes

    def do_hoard(self, strokes, layer):
        hoard = []
        while True:
            hoard.append(bytearray(1 << 24))

    def do_kill(self, strokes, layer):
        print("farewell", file=sys.stderr, flush=True)
        os.kill(os.getpid(), signal.SIGSEGV)

    def do_sleep(self, strokes, layer):
        time.sleep(0.3)
        return strokes

    def do_moody(self, strokes, layer):
        strokes[0][0][0] += int.from_bytes(os.urandom(2), "big") / 1e7
        return strokes

    def do_write(self, strokes, layer):
        layer.polygons[0].outer[0, 0] = 1
        return strokes

    def do_thin(self, strokes, layer):
        return [Stroke(stroke, width_mm=-1) for stroke in strokes]
