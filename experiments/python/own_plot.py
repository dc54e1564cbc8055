"""A plot of one's own from a data frame: travel of every contender on every model.

    python3 own_plot.py RESULTS FILE.png
"""

import sys

import matplotlib

import routebench

matplotlib.use("Agg")
cells = routebench.read_results(sys.argv[1])
valid = cells[cells["outcome"] == "valid"]
table = valid.pivot_table(index="model", columns="contender", values="travel_mm") / 1000
axes = table.plot.barh(figsize=(7, 1.2 + 0.8 * len(table)), width=0.8, colormap="cividis")
axes.set_xlabel("travel [m], mean over the tasks, lower is better")
axes.set_ylabel("")
axes.legend(title="contender", loc="upper left", bbox_to_anchor=(1, 1))
axes.figure.savefig(sys.argv[2], dpi=150, bbox_inches="tight")
print(table.round(2).to_string())
