"""A planner of one's own beside those of the program: planned here, then in an experiment.

    python3 own_planner.py [FOLDER]

The planner is diagonals.py. The experiment runs it as the program runs all planners: each cell in a
process of its own, timed one at a time.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np

import routebench
from diagonals import Diagonals

HERE = Path(__file__).resolve().parent
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else "own_planner")

# While it is being written: a call like any other, on a layer of a real model.
layer = routebench.slice_model("shape:hotend").layers[10]
context = routebench.planner.Context(
    start=np.zeros(2), line_width_mm=0.45, spacing_mm=0.407, line_distance_mm=2.035, density=0.2,
    perimeters=2, seed=1,
)
print(f"{len(list(Diagonals().plan(layer, context)))} lines on layer {layer.index}")

# On the whole model, with walls, and judged.
model = routebench.slice_model("shape:hotend")
plugins = [str(HERE / "diagonals.py")]
fill = {"planner": "diagonals", "turn": True}
plan = routebench.plan(model, "greedy_shell", fill, plugins=plugins)
score = routebench.score(plan)
print(f"{score.outcome}, travel {score.totals['travel_mm']:.0f} mm {score.reason}")

# In an experiment.
FOLDER.mkdir(parents=True, exist_ok=True)
(FOLDER / "experiment.toml").write_text(
    f"""
name = "own_planner"
models = ["shape:hotend", "shape:box?size=20"]
plugins = ["{plugins[0]}"]
[task]
density = 0.2
skin_layers = 0
[[contender]]
name = "diagonals"
shell = {{ planner = "greedy_shell" }}
fill = {{ planner = "diagonals", turn = [true, false] }}
[[contender]]
name = "rectilinear"
shell = {{ planner = "greedy_shell" }}
fill = {{ planner = "rectilinear" }}
""",
    encoding="utf-8",
)
run = ["routebench", "run", FOLDER / "experiment.toml", "--out", FOLDER / "results"]
sys.exit(subprocess.run(run, check=False).returncode)
