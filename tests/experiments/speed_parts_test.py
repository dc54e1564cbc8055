"""Parts of the job beside their bounds."""

from __future__ import annotations

import json
import os
import subprocess
import unittest

import speed_parts
from speed_parts import Cost, Measured, Part


class SpeedParts(unittest.TestCase):
    def test_a_part_is_met_up_to_its_limit(self) -> None:
        part = Part("Read", "read", "bytes", "copy", 12)
        for ours_ms, met in ((120.0, "yes"), (120.1, "no")):
            row = part.row({"read": Measured(ours_ms), "copy": Measured(10.0)})
            self.assertTrue(row.endswith(f"| 12 x | {met} |"), row)
            self.assertIn("| bytes: 10 ms | 12.0 x |", row)

    def test_a_cost_is_that_of_an_item(self) -> None:
        edges = Cost("Hierholzer", "hierholzer", 60, "an edge")
        self.assertIn("| 40 ns an edge | 60 ns | yes |",
                      edges.row({"hierholzer": Measured(400.0, 25e6)}))
        self.assertIn("| 80 ns an edge | 60 ns | no |",
                      edges.row({"hierholzer": Measured(800.0, 12.5e6)}))
        layer = Cost("Coverage", "cover", 3e6, "a layer")
        self.assertIn("| 1.6 ms a layer | 3 ms | yes |", layer.row({"cover": Measured(1.6)}))

    def test_medians_are_read_in_any_unit(self) -> None:
        document = json.dumps({"benchmarks": [
            {"run_name": "a", "aggregate_name": "median", "real_time": 2500, "time_unit": "us"},
            {"run_name": "a", "aggregate_name": "mean", "real_time": 9, "time_unit": "us"},
            {"run_name": "b", "aggregate_name": "median", "real_time": 7, "time_unit": "ms",
             "items_per_second": 3.0}]})
        self.assertEqual(speed_parts.medians(document),
                         {"a": Measured(2.5), "b": Measured(7.0, 3.0)})

    def test_the_table_shows_every_part(self) -> None:
        lines = speed_parts.table({name: Measured(1.0, 1e9) for name in speed_parts.names()})
        self.assertEqual(len(lines), 2 + len(speed_parts.PARTS))
        for line in lines:
            self.assertEqual(line.count("|"), lines[0].count("|"), line)

    def test_what_is_compared_is_measured_together(self) -> None:
        groups = speed_parts.groups()
        self.assertCountEqual([name for group in groups for name in group], speed_parts.names())
        for part in speed_parts.PARTS:
            self.assertTrue(any(set(part.names()) <= set(group) for group in groups), part.label)

    @unittest.skipUnless("ROUTEBENCH_BENCH" in os.environ, "ROUTEBENCH_BENCH names no program")
    def test_the_program_has_every_benchmark(self) -> None:
        listed = subprocess.run([os.environ["ROUTEBENCH_BENCH"], "--benchmark_list_tests=true"],
                                stdout=subprocess.PIPE, check=True, encoding="utf-8").stdout
        self.assertEqual(set(speed_parts.names()) - set(listed.split()), set())


if __name__ == "__main__":
    unittest.main()
