"""A planner that is a program: bars over the box of each polygon, or something wrong as told."""

import json
import os
import sys
import time

crime = sys.argv[1] if len(sys.argv) > 1 else "none"


def say(answer):
    print(json.dumps(answer), flush=True)


def bars(layer, context):
    width, step = context["line_width_mm"], context["line_distance_mm"]
    for polygon in layer["polygons"]:
        xs, ys = zip(*polygon["outer"])
        for k in range(int((max(ys) - min(ys) - width) / step) + 1):
            y = min(ys) + width / 2 + k * step
            yield {"points": [[min(xs) + width / 2, y], [max(xs) - width / 2, y]]}


if crime == "never":
    sys.exit("I will not start")
for line in sys.stdin:
    ask = json.loads(line)
    if ask["request"] == "describe":
        description = {"name": "bars", "role": "fill", "summary": "bars"}
        if crime == "no_role":
            del description["role"]
        if crime == "bad_default":
            description["params"] = [
                {"name": "x", "type": "real", "default": 5, "lowest": 0, "highest": 1}
            ]
        answer = {"routebench": 2 if crime == "version" else 1, "planners": [description]}
        if crime == "two":
            answer["planners"] *= 2
        say(answer)
        continue
    if ask["layer"]["index"] == 1:
        if crime == "exit":
            print("my last words", file=sys.stderr)
            sys.exit(7)
        elif crime == "rubbish":
            print("hello", file=sys.stderr, flush=True)
            print("Planning...", flush=True)
        elif crime == "half":
            print('{"strokes": [', end="", flush=True)
            sys.exit(0)
        elif crime == "list":
            print("[1, 2]", flush=True)
        elif crime == "nothing":
            say({})
        elif crime == "complain":
            say({"error": "this layer\nis ugly"})
        elif crime == "silent":
            time.sleep(3600)
        elif crime == "close":
            os.close(1)
            time.sleep(3600)
        elif crime == "point":
            say({"strokes": [{"points": [[0, 0], [1, "x"]]}]})
        elif crime == "far":
            say({"strokes": [{"points": [[0, 0], [1e300, 0]]}]})
    say({"strokes": list(bars(ask["layer"], ask["context"]))})
