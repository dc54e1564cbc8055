"""The route viewer in a real browser, from disk and without network."""

from __future__ import annotations

import sqlite3
import unittest
from contextlib import closing
from pathlib import Path
from typing import ClassVar

import numpy as np

from report_pages import CANVAS, LAYERS, BrowserTestCase, link, make, stack
from synthetic import Database, made_up_layers


class ViewerTest(BrowserTestCase):
    """All that one can do with a report."""

    page: ClassVar[Path]

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.page = make("report", stack(cls.folder), cls.folder / "report.html")

    def test_loads_from_disk(self) -> None:
        self.open(self.page)
        self.assertEqual(self.browser.value("location.protocol"), "file:")
        self.assertEqual(self.viewer("levels.length"), LAYERS)
        self.assert_drawn(self.picture())
        resources = self.browser.value("performance.getEntriesByType('resource').map(r => r.name)")
        self.assertEqual([r for r in resources if not r.startswith(("data:", "blob:"))], [])

    def test_layers_look_different(self) -> None:
        self.open(self.page, link(a="lines", layer=0, hide="fade"))
        self.key("t")
        self.key("s")
        pictures = []
        for layer in range(3):
            self.assertEqual(self.layer(), layer)
            pictures.append(self.picture())
            self.assert_drawn(pictures[-1])
            self.key("up")
        self.assert_differ(pictures[0], pictures[1])
        self.assert_differ(pictures[1], pictures[2])

    def test_layer_slider(self) -> None:
        self.open(self.page, link(a="lines", layer=5))
        before = self.picture()
        self.browser.run("document.getElementById('v-layer').focus();")
        for _ in range(3):
            self.browser.press("left")
        self.assertEqual(self.layer(), 2)
        self.assert_differ(before, self.picture())
        self.assertIn("2, z 0.5 mm", self.text("#v-layer-text"))

    def test_from_slider_hides_layers_below(self) -> None:
        self.open(self.page, link(a="lines", layer=4))
        count = "sides[0].pane.beads.last - routebench.viewer.sides[0].pane.beads.first"
        every = self.viewer(count)
        self.browser.run("document.getElementById('v-from').focus();")
        self.browser.press("right")
        first = self.viewer("sides[0].route.start(1).segment")
        self.assertEqual(self.viewer(count), every - first)

    def test_move_slider(self) -> None:
        self.open(self.page, link(a="lines", layer=2))
        whole = self.picture()
        most = self.viewer("moveCount()")
        self.browser.run("document.getElementById('v-move').focus();")
        self.browser.press("home")
        self.assertEqual(self.viewer("state.move"), 0)
        none = self.picture()
        self.assert_differ(whole, none)
        for _ in range(9):
            self.browser.press("right")
        self.assertEqual(self.viewer("state.move"), 9)
        self.assert_differ(none, self.picture())
        # Move by move, segments and travels add up.
        pairs = self.viewer(
            "sides.map(s => { const r = s.route, p = s.shown.to, z = r.start(p);"
            f" return Array.from({{length: {most} + 1}}, (_, m) => r.after(p, m))"
            ".map(a => a.segment - z.segment + a.travel - z.travel); })[0]"
        )
        self.assertEqual(pairs, list(range(most + 1)))
        self.browser.press("end")
        self.assertIsNone(self.viewer("state.move"))

    def test_playing(self) -> None:
        self.open(self.page, link(a="lines", layer=2))
        self.key(" ")
        self.browser.wait_for("routebench.viewer.state.move > 3")
        self.key(" ")
        stopped = self.viewer("state.move")
        self.picture()
        self.assertEqual(self.viewer("state.move"), stopped)

    def test_side_by_side(self) -> None:
        self.open(self.page, link(a="lines", layer=3))
        self.assertEqual(self.viewer("sides.length"), 1)
        self.browser.run(
            "const s = document.getElementById('v-b'); s.value = 'c2';"
            "s.dispatchEvent(new Event('change'));"
        )
        self.browser.wait_for("routebench.viewer.sides.length === 2")
        self.key("t")
        image = self.picture()
        half = image.shape[1] // 2
        left, right = image[:, : half - 2], image[:, half + 2 : 2 * half]
        self.assert_drawn(left)
        self.assert_drawn(right)
        self.assert_differ(left, right)
        # One camera: dragging turns both.
        self.browser.drag(CANVAS, 60, -80)
        turned = self.picture()
        self.assert_differ(left, turned[:, : half - 2])
        self.assert_differ(right, turned[:, half + 2 : 2 * half])
        # One slider: both stand at the same share of their moves.
        self.viewer("setMove(Math.round(routebench.viewer.moveCount() / 2))")
        for side in (0, 1):
            shown = self.viewer(f"sides[{side}].shown.moves")
            most = self.viewer(f"sides[{side}].route.movesOf(3)")
            self.assertAlmostEqual(shown / most, 0.5, delta=1 / most)
        self.key("x")
        self.browser.wait_for("routebench.viewer.sides[0].source.name === 'linked'")

    def test_a_contender_without_route_says_why(self) -> None:
        self.open(self.page, link(a="lines", b="broken"))
        labels = self.text("#v-labels")
        self.assertIn("crashed: signal 11", labels)

    def test_colours_and_legend(self) -> None:
        self.open(self.page, link(a="lines", b="linked", layer=4))
        self.key("t")
        legend = "document.getElementById('v-legend').textContent"
        seen = []
        for mode, words in (
            ("kind", ("wall", "dense", "sparse", "travel", "crossing", "retraction")),
            ("order", ("first", "last of its layer")),
            ("speed", ("mm/s",)),
            ("contender", ("lines", "linked")),
        ):
            self.assertEqual(self.viewer("state.colour"), mode)
            for word in words:
                self.assertIn(word, self.browser.value(legend))
            seen.append(self.picture())
            self.key("c")
        for one, other in zip(seen, seen[1:]):
            self.assert_differ(one, other)

    def test_toggles(self) -> None:
        self.open(self.page, link(a="lines", layer=4))
        self.key("t")
        before = self.picture()
        names = ("strokes", "travels", "crossings", "retractions", "outline", "fade")
        for number, name in enumerate(names, 1):
            self.key(str(number))
            self.assertFalse(self.viewer(f"state.shown.{name}"))
            self.assertFalse(self.browser.value(f"document.getElementById('v-{name}').checked"))
            after = self.picture()
            with self.subTest(name):
                self.assert_differ(before, after)
            self.key(str(number))

    def test_deep_link_leads_back(self) -> None:
        self.open(self.page, link(a="lines", b="linked", layer=4))
        for key in ("down", "c", "2", "t"):
            self.key(key)
        self.viewer("setMove(7)")
        self.browser.wait_for("location.hash.includes('move=7')")
        self.browser.wait_for("location.hash.includes('hide=travels')")
        hash_ = self.browser.value("location.hash")
        state = self.viewer("state")
        image = self.picture()
        self.open(self.page, hash_)
        self.assertEqual(self.viewer("state"), state)
        self.assertEqual(self.layer(), 3)
        self.assertLess(np.abs(self.picture() - image).mean(), 0.01)

    def test_a_link_to_what_is_not_there_says_so(self) -> None:
        self.open(self.page, link(a="nobody"))
        self.assertIn("no contender “nobody”", self.text("#v-status"))

    def test_worst_layer(self) -> None:
        self.open(self.page, link(a="lines", layer=0))
        travel = [row["travel_mm"] for row in made_up_layers(1, 1, LAYERS)]
        ranked = sorted(range(LAYERS), key=lambda i: -(travel[i] or 0))
        for nth in range(3):
            self.key("w")
            self.assertEqual(self.layer(), ranked[nth])

    def test_largest_difference(self) -> None:
        self.open(self.page, link(a="lines", b="linked", layer=0))
        one, other = (
            [row["travel_mm"] or 0 for row in made_up_layers(1, c, LAYERS)] for c in (1, 2)
        )
        gaps = [abs(a - b) for a, b in zip(one, other)]
        self.key("d")
        self.assertEqual(self.layer(), gaps.index(max(gaps)))

    def test_table_sorts_and_filters(self) -> None:
        self.open(self.page)
        travel = (
            "[...document.querySelectorAll('#table tbody tr')].map(r => r.cells[4].textContent)"
        )
        head = "#table thead th:nth-child(5) button"
        self.assertIn("Travel", self.text(head))

        def numbers() -> list[float]:
            texts = self.browser.value(travel)
            self.assertEqual(len(texts), 12)
            values = [float(t.replace("\u202f", "")) for t in texts if t != "n/a"]
            # What is absent comes last, whichever way.
            self.assertEqual(texts[len(values):], ["n/a"] * 4)
            return values

        self.browser.click(head)
        self.assertEqual(numbers(), sorted(numbers()))
        self.browser.click(head)
        self.assertEqual(numbers(), sorted(numbers(), reverse=True))
        order = "document.querySelector('#table th[aria-sort]').ariaSort"
        self.assertEqual(self.browser.value(order), "descending")
        self.browser.run(
            "const f = document.querySelector('#table input[type=search]');"
            "f.value = 'OTHER crash';"
            "f.dispatchEvent(new Event('input'));"
        )
        self.assertEqual(self.text("#table output"), "2 of 12 cells")

    def test_every_figure_of_the_table_leads_to_a_layer(self) -> None:
        self.open(self.page)
        links = self.browser.value(
            "[...document.querySelectorAll('#table tbody td.number a')].map(a => a.hash)"
        )
        self.assertEqual(len(links), 8 * 9)
        self.browser.click("#table tbody tr:nth-child(2) td:nth-child(6) a")
        self.browser.wait_for("routebench.viewer.message.includes('worst by Retractions')")
        scores = [row["retractions"] for row in made_up_layers(2, 2, LAYERS)]
        name = self.viewer("sides[0].source.name")
        model = self.viewer("experiment.models[routebench.viewer.state.model]")
        self.assertEqual(model, "other.stl")
        if name == "linked":
            self.assertEqual(scores[self.layer()], max(s or 0 for s in scores))

    def test_wheel_scrolls_the_page_until_the_picture_is_clicked(self) -> None:
        self.open(self.page)
        turn = (
            "document.getElementById('v-canvas').dispatchEvent("
            "new WheelEvent('wheel', {deltaY: -300, bubbles: true, cancelable: true}))"
        )
        before = self.viewer("stage.cameraPlace()")
        self.assertTrue(self.browser.value(turn), "the page may scroll")
        self.assertEqual(self.viewer("stage.cameraPlace()"), before)
        self.browser.click(CANVAS)
        self.assertFalse(self.browser.value(turn), "the picture has taken it")
        self.assertNotEqual(self.viewer("stage.cameraPlace()"), before)

    def test_keys_are_listed(self) -> None:
        self.open(self.page)
        self.key("?")
        self.assertTrue(self.browser.value("document.getElementById('v-keys').open"))
        self.browser.press("escape")
        self.assertFalse(self.browser.value("document.getElementById('v-keys').open"))

    def test_every_control_has_a_name(self) -> None:
        self.open(self.page)
        nameless = self.browser.value(
            "[...document.querySelectorAll('button, input, select, canvas')].filter(e =>"
            " !(e.textContent.trim() || e.labels?.length || e.getAttribute('aria-label')"
            " || e.getAttribute('aria-labelledby'))).map(e => e.outerHTML)"
        )
        self.assertEqual(nameless, [])


class KeptTest(BrowserTestCase):
    """Where only some layers' routes were kept."""

    def test_says_so(self) -> None:
        page = make("view", stack(self.folder, range(2, 4)), self.folder / "view.html")
        self.open(page, link(a="lines"))
        self.assertIn("Routes of 2 of 6 layers were kept", self.text("#v-kept"))
        travel = [row["travel_mm"] or 0 for row in made_up_layers(1, 1, LAYERS)]
        worst = travel.index(max(travel))
        self.assertNotIn(worst, (2, 3))
        self.key("w")
        message = self.viewer("message")
        self.assertIn(f"layer {worst} is the worst", message)
        self.assertIn("its route was not kept", message)
        self.assertEqual(self.layer(), 2 if travel[2] > travel[3] else 3)
        self.open(page, link(a="lines", layer=5))
        self.assertIn("layer 5 was not kept", self.viewer("message"))
        self.assertEqual(self.layer(), 3)


class PhoneTest(BrowserTestCase):
    """A narrow screen."""

    def test_nothing_is_wider_than_the_screen(self) -> None:
        results = stack(self.folder)
        with closing(sqlite3.connect(results / "results.sqlite")) as database, database:
            database.execute(
                "UPDATE setting SET task_json = json_set(task_json, '$.x', ?)", ("x " * 99,)
            )
        page = make("report", results, self.folder / "report.html")
        self.browser.become_a_phone()
        self.open(page)
        for section in self.browser.run(
            "for (const one of document.querySelectorAll('details')) one.open = true;"
            "return [...document.querySelectorAll('section')].map(s => [s.id, s.scrollWidth]);"
        ):
            self.assertLessEqual(section[1], 390, section)
        self.assertEqual(self.browser.value("innerWidth"), 390)
        self.assert_drawn(self.picture())


class MillionTest(BrowserTestCase):
    """A million segments: shown whole, and scrubbed; how fast is printed, not judged."""

    STROKES, POINTS = 100, 101
    LAYERS = 100

    def test_million(self) -> None:
        made = Database(self.folder / "results.sqlite")
        cell = made.cell(
            made.model("large.stl"),
            made.contender("noise"),
            made.setting(),
            {"travel_mm": 1.0},
        )
        rng = np.random.default_rng(3)
        for layer in range(self.LAYERS):
            made.shape(1, layer)
            strokes = []
            for line in range(self.STROKES):
                # Noise, which cannot be packed as well as a pattern.
                x = (np.linspace(0, 50, self.POINTS) + rng.uniform(0, 0.2, self.POINTS)).round(4)
                y = (line * 0.3 + rng.uniform(0, 0.2, self.POINTS)).round(4)
                points = np.column_stack([x, y])[:: 1 if line % 2 else -1]
                strokes.append({"kind": "sparse", "width_mm": 0.45, "points": points.tolist()})
            made.route(cell, layer, strokes)
        made.close()
        page = make("view", self.folder, self.folder / "million.html")
        self.open(page)
        self.assertEqual(self.viewer("sides[0].route.segmentCount"), 1_000_000)
        ready_ms = self.browser.value("performance.getEntriesByName('ready')[0].startTime")
        self.browser.wait_for("routebench.stage.complete")
        drawn_ms = self.browser.value("performance.now()")
        before = self.picture()
        self.assert_drawn(before)
        scrub_ms = self.browser.run(
            "const { viewer, stage } = routebench;"
            "const begin = performance.now();"
            "for (let i = 0; i < 100; i++) viewer.setMove(i * 90);"
            "return (performance.now() - begin) / 100;"
        )
        frame_ms = self.browser.run(
            "const { stage } = routebench;"
            "const begin = performance.now();"
            "stage.restart = true; stage.render();"
            "return performance.now() - begin;"
        )
        print(
            f"\n1,000,000 segments: page of {page.stat().st_size / 1e6:.1f} MB, ready after "
            f"{ready_ms / 1000:.2f} s, drawn without graphics card after {drawn_ms / 1000:.2f} s; "
            f"a step of the slider {scrub_ms:.2f} ms, its first frame {frame_ms:.0f} ms"
        )
        self.viewer("setLevel(40)")
        self.assert_differ(before, self.picture())


if __name__ == "__main__":
    unittest.main()
