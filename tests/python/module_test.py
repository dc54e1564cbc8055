"""The module routebench does what the program does, bit for bit."""

import gc
import json
import re
import sqlite3
import sys
import threading
import unittest
from unittest import mock

import numpy as np
import routebench
from routebench.planner import Layer, Polygon, Stroke

from support import PLANNERS, FolderTest

CULPRIT = str(PLANNERS / "culprit.py")
MODEL = "shape:gear"
CONFIG = f"""
name = "same"
models = ["{MODEL}"]
[task]
density = [0.2, 1]
[run]
repetitions = 2
keep_layers = "all"
[[contender]]
name = "lines"
shell = {{ planner = "greedy_shell" }}
fill = {{ planner = "rectilinear", angle_deg = 30 }}
[[contender]]
name = "rings"
shell = {{ planner = "greedy_shell" }}
fill = {{ planner = "concentric" }}
"""


def rings_of_wkt(text: str) -> list[np.ndarray]:
    """The rings of a MULTIPOLYGON, without their repeated first points."""
    return [
        np.array([[float(word) for word in point.split()[:2]] for point in ring.split(",")])[:-1]
        for ring in re.findall(r"\(([^()]+)\)", text)
    ]


class MeshTest(unittest.TestCase):
    """Meshes as arrays."""

    def test_arrays_look_into_the_mesh_and_outlive_its_name(self) -> None:
        mesh = routebench.load_mesh("shape:box?size=20")
        vertices, triangles = mesh.vertices, mesh.triangles
        self.assertEqual((vertices.shape[1], vertices.dtype), (3, np.float64))
        self.assertEqual((triangles.shape[1], triangles.dtype), (3, np.uint32))
        self.assertIs(vertices.base, mesh)
        self.assertTrue(np.shares_memory(vertices, mesh.vertices))
        corners = vertices[triangles]
        volume = np.linalg.det(corners).sum() / 6
        self.assertAlmostEqual(volume, routebench.mesh_report(mesh)["volume_mm3"], places=6)
        kept = vertices.copy()
        del mesh
        gc.collect()
        self.assertTrue(np.array_equal(vertices, kept))

    def test_nothing_can_be_written(self) -> None:
        mesh = routebench.load_mesh("shape:box")
        layer = routebench.slice_model("shape:box").layers[0]
        for array in (mesh.vertices, mesh.triangles, layer.polygons[0].outer):
            with self.assertRaises(ValueError):
                array[0] = 1
            with self.assertRaises(ValueError):
                array.setflags(write=True)
        with self.assertRaises(AttributeError):
            mesh.spec = "other"
        with self.assertRaises(AttributeError):
            layer.index = 3


class SameTest(FolderTest):
    """Compares with what the program writes."""

    def test_layers_and_routes_and_scores_are_those_of_the_program(self) -> None:
        self.run_experiment(CONFIG, expect=0)
        database = sqlite3.connect(self.folder / "results" / "results.sqlite")
        self.addCleanup(database.close)
        fills = {"lines": {"planner": "rectilinear", "angle_deg": 30}, "rings": "concentric"}
        compared = 0
        for density in (0.2, 1):
            model = routebench.slice_model(MODEL, density=density, jobs=2)
            for name, fill in fills.items():
                plan = routebench.plan(model, "greedy_shell", fill, jobs=2)
                (cell,) = database.execute(
                    "SELECT cell_id FROM cell JOIN contender USING(contender_id) JOIN setting"
                    " USING(setting_id) WHERE name = ?"
                    " AND json_extract(task_json, '$.density') = ?",
                    (name, density),
                ).fetchone()
                self.compare_routes(database, cell, plan)
                self.compare_scores(database, cell, routebench.score(plan, jobs=2))
                compared += 1
            for layer, (wkt,) in zip(
                model.layers,
                database.execute(
                    "SELECT wkt FROM layer_shape WHERE model_id = 1 ORDER BY layer_index"
                ),
                strict=True,
            ):
                rings = [ring for polygon in layer.polygons for ring in polygon.rings]
                self.assertTrue(all(map(np.array_equal, rings, rings_of_wkt(wkt))))
                self.assertEqual(len(rings), len(rings_of_wkt(wkt)))
        self.assertEqual(compared, 4)

    def compare_routes(
        self, database: sqlite3.Connection, cell: int, plan: routebench.Plan
    ) -> None:
        rows = database.execute(
            "SELECT layer_index, strokes_json FROM route WHERE cell_id = ? ORDER BY layer_index",
            (cell,),
        ).fetchall()
        self.assertEqual([index for index, _ in rows], plan.indices)
        for place, (_, text) in enumerate(rows):
            for theirs, ours in zip(json.loads(text), plan.strokes(place), strict=True):
                self.assertTrue(np.array_equal(ours.points, np.array(theirs["points"])))
                self.assertEqual(
                    (ours.width_mm, ours.kind), (theirs["width_mm"], theirs["kind"])
                )

    def compare_scores(
        self, database: sqlite3.Connection, cell: int, score: routebench.Score
    ) -> None:
        self.assertEqual((score.outcome, score.reason), ("valid", ""))
        theirs = dict(
            database.execute("SELECT metric, value FROM cell_score WHERE cell_id = ?", (cell,))
        )
        measured = {"plan_wall_ns", "plan_cpu_ns", "peak_rss_bytes"}
        known = {name for name, value in score.totals.items() if value is not None}
        self.assertEqual({name for name in theirs if theirs[name] is not None}, known)
        for name in known - measured:
            self.assertEqual(score.totals[name], theirs[name], name)

    def test_task_and_printer_are_those_of_configs(self) -> None:
        model = routebench.slice_model(
            "shape:hotend", layer_height_mm=0.3, density=1, start_mm=(1, 2), skin_rule="slope"
        )
        task = routebench.task_of(model)
        self.assertEqual(
            (task["layer_height_mm"], task["density"], task["start_mm"], task["skin_rule"]),
            (0.3, 1, [1, 2], "slope"),
        )
        plan = routebench.plan(model, "greedy_shell", "rectilinear", layers=[4, 2, 4])
        self.assertEqual(plan.indices, [2, 4])
        score = routebench.score(plan)
        self.assertIn(score.outcome, repr(score))
        self.assertNotIn("per_layer", repr(score), "what is printed stays short")
        few = routebench.score(plan, retract_over_mm=1e3).totals["retractions"]
        many = routebench.score(plan, retract_over_mm=0).totals["retractions"]
        self.assertEqual(few, 0)
        self.assertGreater(many, 0)


class PlannersTest(unittest.TestCase):
    """Planners in Python, with the module and without a program."""

    def test_a_python_planner_plans_beside_the_others(self) -> None:
        model = routebench.slice_model("shape:box?size=6", perimeters=0, density=1)
        fill = {"planner": "py_culprit", "crime": "none"}
        plans = [
            routebench.plan(model, None, fill, plugins=[CULPRIT], jobs=jobs) for jobs in (1, 2)
        ]
        for place in range(len(plans[0])):
            for a, b in zip(plans[0].strokes(place), plans[1].strokes(place), strict=True):
                self.assertTrue(np.array_equal(a.points, b.points))
        self.assertGreater(len(plans[0].strokes(0)), 3)
        self.assertIn("py_culprit", routebench.planners([CULPRIT]))
        self.assertNotIn("py_culprit", routebench.planners())

    def test_coordinates_cross_the_border_bit_for_bit(self) -> None:
        model = routebench.slice_model("shape:gear?size=47.3")
        plugins = [str(PLANNERS / "echo.py")]
        plan = routebench.plan(model, "echo", order="stage", plugins=plugins)
        rings = 0
        for place, layer in enumerate(model.layers):
            expected = [ring for polygon in layer.polygons for ring in polygon.rings]
            for stroke, ring in zip(plan.strokes(place), expected, strict=True):
                self.assertTrue(np.array_equal(stroke.points[:-1], ring))
                self.assertTrue(np.array_equal(stroke.points[-1], ring[0]))
                rings += 1
        self.assertGreater(rings, len(model))

    def test_offset_and_order(self) -> None:
        ring = np.array([[0, 0], [10, 0], [10, 10], [0, 10.0]])
        hole = np.array([[4, 4], [4, 6], [6, 6], [6, 4.0]])
        (shrunk,) = routebench.offset([Polygon(ring, (hole,))], -1)
        self.assertEqual((shrunk.outer.min(), shrunk.outer.max()), (1, 9))
        self.assertEqual((shrunk.holes[0].min(), shrunk.holes[0].max()), (3, 7))
        self.assertEqual(routebench.offset([Polygon(ring)], -6), ())
        strokes = [[[9, 0], [5, 0]], Stroke([[0, 0], [1, 0]], 0.7), np.array([[2.0, 0], [3, 0]])]
        order = routebench.nearest_first(strokes, (0, 0))
        self.assertEqual([stroke.points[0, 0] for stroke in order], [0, 2, 5])
        self.assertEqual([stroke.width_mm for stroke in order], [0.7, None, None])

    def test_a_planner_can_be_called_directly(self) -> None:
        sys.path.insert(0, str(PLANNERS))
        self.addCleanup(sys.path.remove, str(PLANNERS))
        from culprit import Culprit

        from routebench.planner import Context

        layer = routebench.slice_model("shape:box?size=6").layers[3]
        self.assertIsInstance(layer, Layer)
        context = Context(np.zeros(2), 0.45, 0.4, 0.4, 1, 2, 1)
        self.assertGreater(len(Culprit({"crime": "none"}).plan(layer, context)), 10)


class ThreadsTest(unittest.TestCase):
    """Other threads of Python go on while C++ works."""

    def test_plans_on_several_threads_are_equal_and_do_not_hold_the_lock(self) -> None:
        model = routebench.slice_model("shape:gear")
        inside = threading.Event()
        results: list[routebench.Plan] = []

        def work() -> None:
            inside.set()
            results.append(routebench.plan(model, "greedy_shell", "rectilinear"))

        threads = [threading.Thread(target=work) for _ in range(3)]
        for thread in threads:
            thread.start()
        inside.wait()
        steps = 0
        while any(thread.is_alive() for thread in threads):
            steps += 1
            threads[0].join(0.001)
        self.assertGreater(steps, 1)
        first = results[0]
        for other in results[1:]:
            for place in range(len(first)):
                for a, b in zip(first.strokes(place), other.strokes(place), strict=True):
                    self.assertTrue(np.array_equal(a.points, b.points))

    def test_ctrl_c_stops_an_endless_planner(self) -> None:
        import _thread

        model = routebench.slice_model("shape:box?size=6", perimeters=0)
        fill = {"planner": "py_culprit", "crime": "loop"}
        timer = threading.Timer(1.0, _thread.interrupt_main)
        timer.start()
        self.addCleanup(timer.cancel)
        with self.assertRaises(KeyboardInterrupt):
            routebench.plan(model, None, fill, plugins=[CULPRIT])


class ErrorsTest(FolderTest):
    """One line, as from the program."""

    def refusal(self, call: object, *arguments: object, **named: object) -> str:
        with self.assertRaises(routebench.Error) as caught:
            call(*arguments, **named)
        text = str(caught.exception)
        self.assertNotIn("\n", text)
        return text

    def test_messages_are_those_of_the_program(self) -> None:
        model = routebench.slice_model("shape:box?size=6")
        said = self.call("plan", "shape:box?size=6", "--fill", "rectlinear", expect=2).stderr
        self.assertEqual(
            f"routebench: {self.refusal(routebench.plan, model, fill='rectlinear')}\n", said
        )
        said = self.call("slice", "missing.stl", "--json", "-", expect=2).stderr
        self.assertEqual(
            f"routebench: {self.refusal(routebench.load_mesh, 'missing.stl')}\n", said
        )

    def test_what_cannot_be_meant_is_refused(self) -> None:
        model = routebench.slice_model("shape:box?size=6")
        slicing, plan = routebench.slice_model, routebench.plan
        self.assertIn("did you mean", self.refusal(slicing, "shape:box", densty=1))
        self.assertIn("method", self.refusal(slicing, "shape:box", method="magic"))
        self.assertIn("parameter density is a set", self.refusal(slicing, "shape:box", density={1}))
        self.assertIn("no planner", self.refusal(plan, model))
        self.assertIn("lacks the key planner", self.refusal(plan, model, fill={"angle_deg": 3}))
        self.assertIn("must be a planner's name", self.refusal(plan, model, fill=3))
        self.assertIn(
            "layer 9999 is not there", self.refusal(plan, model, fill="voxel", layers=[9999])
        )
        self.assertIn("refused", self.refusal(plan, model, fill="x", plugins=["missing.py"]))
        finished = plan(model, "greedy_shell")
        self.assertIn("did you mean", self.refusal(routebench.score, finished, retract=1))
        with self.assertRaises(IndexError):
            finished.strokes(10_000)
        polygon = Polygon(np.array([[0, 0], [float("nan"), 1], [1, 1]]))
        self.assertIn("must be finite", self.refusal(routebench.offset, [polygon], 1))
        self.assertIn("no rings", self.refusal(routebench.offset, [3], 1))
        self.assertIn("shape (n, 2)", self.refusal(routebench.nearest_first, [[1, 2]], (0, 0)))

    def test_a_failing_planner_is_named(self) -> None:
        model = routebench.slice_model("shape:box?size=6", perimeters=0)
        fill = {"planner": "py_culprit", "crime": "throw"}
        self.assertRegex(
            self.refusal(routebench.plan, model, None, fill, plugins=[CULPRIT]),
            "^planner py_culprit, layer 1: ValueError: no mood",
        )


class ResultsTest(FolderTest):
    """Databases as data frames."""

    def test_forms_hold_what_the_database_holds(self) -> None:
        self.run_experiment(CONFIG, expect=0)
        wide = routebench.read_results(self.folder / "results")
        metrics = list(routebench.metrics())
        self.assertEqual(len(wide), 4)
        self.assertEqual([name for name in wide.columns if name in metrics], metrics)
        self.assertEqual(set(wide["outcome"]), {"valid"})
        self.assertEqual(set(wide["fill.angle_deg"].dropna()), {30})
        long = routebench.read_results(self.folder / "results" / "results.sqlite", "long")
        self.assertEqual(len(long), 4 * len(metrics))
        back = long.pivot(index=["contender", "setting"], columns="metric", values="value")
        wide = wide.set_index(["contender", "setting"])
        for name in metrics:
            same = np.array_equal(
                back[name].sort_index().astype(float),
                wide[name].sort_index().astype(float),
                equal_nan=True,
            )
            self.assertTrue(same, name)
        layers = routebench.read_results(self.folder / "results", "layers")
        sums = layers.groupby(["contender", "setting"])["extrude_mm"].sum().sort_index()
        self.assertTrue(np.allclose(sums, wide["extrude_mm"].sort_index()))
        timings = routebench.read_results(self.folder / "results", "timings")
        self.assertEqual(len(timings), 4 * 2)

    def test_what_is_no_database_is_refused(self) -> None:
        with self.assertRaisesRegex(routebench.Error, "no results database here"):
            routebench.read_results(self.folder)
        (self.folder / "results.sqlite").write_text("no database at all", encoding="utf-8")
        with self.assertRaisesRegex(routebench.Error, "is no results database"):
            routebench.read_results(self.folder)
        with self.assertRaisesRegex(routebench.Error, "must be one of wide, long, layers, timings"):
            routebench.read_results(self.folder, "broad")

    def test_without_pandas_it_says_so(self) -> None:
        with mock.patch.dict(sys.modules, {"pandas": None}):
            with self.assertRaisesRegex(ImportError, "install the package python3-pandas"):
                routebench.read_results(self.folder)


class StubsTest(unittest.TestCase):
    """Every name has a description and a stub."""

    def test_all_is_described(self) -> None:
        for name in routebench.__all__:
            if name != "__version__":
                self.assertTrue(getattr(routebench, name).__doc__, name)

    def test_the_stubs_name_what_the_compiled_part_has(self) -> None:
        from pathlib import Path

        from routebench import _routebench

        stubs = (Path(routebench.__file__).parent / "_routebench.pyi").read_text(encoding="utf-8")
        stubbed = set(re.findall(r"^(?:class|def) (\w+)|^(__version__)", stubs, re.M))
        names = {name for pair in stubbed for name in pair if name} - {"_Area"}
        special = {"__doc__", "__file__", "__loader__", "__name__", "__package__", "__spec__"}
        self.assertEqual(names, set(vars(_routebench)) - special)
        for kind in ("Mesh", "SlicedModel", "Plan"):
            block = re.search(rf"^class {kind}:\n((?:    .*\n)+)", stubs, re.M).group(1)
            members = set(re.findall(r"def (\w+)", block))
            real = {n for n in vars(getattr(_routebench, kind)) if not n.startswith("__")}
            self.assertEqual(members - {"__len__"}, real)


if __name__ == "__main__":
    unittest.main()
