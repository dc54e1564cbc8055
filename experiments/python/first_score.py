"""A first score: slice a model, plan it in two ways, let the judge compare them.

    python3 first_score.py [MODEL]
"""

import sys

import routebench

spec = sys.argv[1] if len(sys.argv) > 1 else "shape:gear"
model = routebench.slice_model(spec, density=0.25)
print(f"{spec}: {len(model)} layers, the lowest has {len(model.layers[0].polygons)} polygons")

for fill in ("rectilinear", {"planner": "rectilinear", "angle_deg": 45}, "concentric"):
    plan = routebench.plan(model, shell="greedy_shell", fill=fill)
    score = routebench.score(plan)
    travel = score.totals["travel_mm"] / 1000
    minutes = score.totals["print_time_s"] / 60
    print(f"{score.outcome:8}  travel {travel:6.2f} m  print {minutes:5.1f} min  {fill}")
