"""Names stay apart, numbers readable, lines within their width."""

from __future__ import annotations

import unittest

from routebench_plots.naming import (
    distinct_labels,
    file_slugs,
    printable,
    short_specs,
)
from routebench_plots.quantities import (
    format_number,
    in_sentence,
    quantity,
    scale_for,
)
from routebench_plots.results import Metric
from routebench_plots.text import text_width, wrap


class LabelTest(unittest.TestCase):
    """Labels and file names."""

    def test_labels_are_distinct(self) -> None:
        names = [("a", "1234567890"), ("b", "x"), ("a", "abcdefghi")]
        self.assertEqual(
            distinct_labels(names), ["a [1234567]", "b", "a [abcdefg]"]
        )
        same = distinct_labels([("a", "1"), ("a", "1"), ("a\n", "1")])
        self.assertEqual(len(set(same)), 3)

    def test_models_are_called_by_the_end_of_their_path(self) -> None:
        expected = {
            "/home/me/parts/left/lid.stl": "left/lid.stl",
            "/home/me/parts/right/lid.stl": "right/lid.stl",
            "/home/me/parts/hook.3mf?size=60": "hook.3mf?size=60",
            "/home/me/parts/hook.3mf?size=30": "hook.3mf?size=30",
            "../shared//box.stl": "box.stl",
            "lid.stl": "lid.stl",
            "/lid.obj?repair=a/b": "lid.obj?repair=a/b",
            "shape:gear?teeth=12": "shape:gear?teeth=12",
            "cgal:meshes/elephant.off": "cgal:meshes/elephant.off",
        }
        self.assertEqual(short_specs([*expected, *expected]), expected)
        # An end that is another's whole name is no name.
        self.assertEqual(
            short_specs(["b.stl", "/a/b.stl"]), {"b.stl": "b.stl", "/a/b.stl": "a/b.stl"}
        )
        self.assertEqual(short_specs(["/b.stl", "b.stl"]), {"/b.stl": "/b.stl", "b.stl": "b.stl"})

    def test_printable_is_one_line(self) -> None:
        self.assertEqual(printable(" a\tb\r\nc\x00d\u2028e "), "a b c d e")

    def test_slugs_are_safe_and_distinct(self) -> None:
        labels = [
            "../../etc/passwd",
            "..",
            "",
            "density=0.2, retract_over_mm=1",
            "A b",
            "a/B",
            "ä",
            "x" * 300,
            "x" * 299,
        ]
        slugs = file_slugs(labels)
        for slug in slugs.values():
            self.assertRegex(slug, r"^[A-Za-z0-9=_][A-Za-z0-9.=_-]*$")
            self.assertLess(len(slug), 80)
        lowered = {slug.lower() for slug in slugs.values()}
        self.assertEqual(len(lowered), len(labels))
        self.assertEqual(
            slugs["density=0.2, retract_over_mm=1"],
            "density=0.2-retract_over_mm=1",
        )


class NumberTest(unittest.TestCase):
    """Numbers and units."""

    def test_numbers(self) -> None:
        for value, text in (
            (0.0, "0"),
            (-0.0, "0"),
            (7.0, "7"),
            (1234567.0, "1\u202f234\u202f567"),
            (1234.56, "1\u202f235"),
            (0.95, "0.95"),
            (0.123456, "0.1235"),
            (12.3456, "12.35"),
            (99.9999, "100"),
            (-2.5, "\u22122.5"),
            (0.00012345, "0.0001234"),
            (1.5e-7, "1.5e\u221207"),
            (3.21e12, "3.21e+12"),
        ):
            self.assertEqual(format_number(value), text)

    def test_units_fit_the_largest_value(self) -> None:
        for unit, value, wanted in (
            ("ns", 900.0, "ns"),
            ("ns", 2e3, "µs"),
            ("ns", 2e6, "ms"),
            ("ns", 2e9, "s"),
            ("mm", 99999.0, "mm"),
            ("mm", 100000.0, "m"),
            ("bytes", 3e6, "MiB"),
            ("", 1e9, ""),
            ("furlong", 1e9, "furlong"),
        ):
            metric = Metric("n", "l", unit, "lower", "sum", "m")
            self.assertEqual(scale_for(metric, [0.0, value]).unit, wanted)
        metric = Metric("n", "l", "ns", "lower", "sum", "m")
        self.assertEqual(scale_for(metric, [2e9])(5e8), 0.5)
        self.assertEqual(scale_for(metric, []).unit, "ns")

    def test_sentences(self) -> None:
        self.assertEqual(quantity(2.5, "mm3"), "2.5 mm³")
        self.assertEqual(quantity(3, ""), "3")
        self.assertEqual(in_sentence("Travel"), "travel")
        self.assertEqual(in_sentence("CPU time"), "CPU time")


class WrapTest(unittest.TestCase):
    """Lines of text."""

    def check(self, text: str, width: float) -> list[str]:
        """Every line fits, and nothing is lost but white space."""
        lines = wrap(text, width, 8)
        for line in lines:
            self.assertLessEqual(text_width(line, 8), width)
        self.assertEqual(
            "".join("".join(lines).split()), "".join(text.split())
        )
        return lines

    def test_nothing_is_lost(self) -> None:
        for text in (
            "",
            "word",
            "many words in a long sentence that does not end",
            "shape:hot_end?size=40&resolution=123456",
            "x" * 200,
            "a" * 30 + "/" + "b" * 30 + " and a tail",
            "--- ??? ///",
        ):
            for width in (0.5, 1.0, 3.0):
                self.check(text, width)

    def test_words_break_before_their_punctuation_does(self) -> None:
        lines = self.check("shell + rectilinear [fill.angle_deg=45]", 1.3)
        self.assertEqual(lines, ["shell + rectilinear", "[fill.angle_deg=45]"])

    def test_paths_break_after_separators(self) -> None:
        lines = self.check("models/of/some/folder/part.stl", 1.0)
        self.assertGreater(len(lines), 1)
        self.assertTrue(lines[0].endswith("/"))


if __name__ == "__main__":
    unittest.main()
