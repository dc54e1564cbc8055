"""The project that `new-planner --python` writes."""

import re
import unittest

from support import FolderTest


class TemplateTest(FolderTest):
    """`new-planner --python` writes what works at once."""

    def test_it_passes_the_conformance_test_and_its_experiment(self) -> None:
        written = self.call("new-planner", "my_rings", "mine", "--python").stdout
        commands = re.findall(r"^  routebench (.*)$", written, re.M)
        self.assertEqual(len(commands), 3)
        self.assertEqual(
            sorted(file.name for file in (self.folder / "mine").iterdir()),
            ["experiment.toml", "my_rings.py"],
        )
        source = (self.folder / "mine" / "my_rings.py").read_text(encoding="utf-8")
        self.assertLess(source.count("\n"), 80)
        self.assertNotIn("@", source)
        self.folder = self.folder / "mine"
        checked = self.call(*commands[0].split())
        self.assertEqual(checked.stdout.count("\npass  "), 8)
        self.assertNotIn("\nFAIL", checked.stdout)
        ran = self.call(*commands[1].split())
        self.assertIn("18 cells: 18 valid", ran.stdout)


if __name__ == "__main__":
    unittest.main()
