"""The C++ on the page for writers of planners is compiled, and what it calls is called."""

import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ["ROUTEBENCH_PROGRAM"]).parents[1]
COMPILER = os.environ.get("CXX", "c++")
PAGE = SOURCE / "planners" / "README.md"
HEADERS = {
    "": "planners/include/routebench/planning",
    "geometry ": "geometry/include/routebench/geometry",
}

# What the page says one has at hand: an island with a hole, and what belongs to it.
AT_HAND = """
using namespace routebench;

struct AtHand {
  PlanContext context;
  Ring square{{0, 0}, {20, 0}, {20, 20}, {0, 20}};
  Polygon region{square, {{{5, 5}, {5, 8}, {8, 8}, {8, 5}}}};
  const Polygon& island = region;
  Polygons polygons{region};
  Polygons area = polygons;
  Polygons other{{{{10, 10}, {30, 10}, {30, 30}, {10, 30}}, {}}};
  Polygons thin{{{{0, 0}, {9, 0}, {9, 0.5}, {0, 0.5}}, {}}};
  Layer layer;
  Ring ring = square;
  RingPlace place{0, {1, 0}}, from = place, to{2, {3, 20}};
  Point2 a{1, 1}, b{12, 14}, p{3, 2}, start{0, 0};
  std::vector<Point2> points{{0, 0}, {1, 0}, {1, 1}, {3, 1}};
  std::vector<Point2> places = points;
  std::size_t nodes = 4;
  std::vector<Multigraph::Ends> edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  std::vector<Polygons> insets{offset(polygons, -0.3), offset(polygons, -0.7)};
  std::vector<Polygons> regions;
  std::vector<Stroke> strokes{{points, 0.45}, {{{9, 9}, {9, 12}}, 0.45}};
  std::vector<TourItem> items{{{{a, b}, {b, a}}}, {{{p, p}}}};
  Stroke stroke;
  Route route{strokes};
  std::uint32_t i = 1;
  int count = 2;
  double mm = 2, from_mm = 1, to_mm = 30, width_mm = 0.4, widest_mm = 0.6, step_mm = 0.4;
  double reach_mm = 0.2, near_mm = 0.27;

  AtHand() {
    context.perimeters = 2;
    layer.polygons = polygons;
    regions = wall_regions(island, context);
  }
};
"""


def spans(text: str) -> list[str]:
    """What stands in backticks."""
    return re.findall(r"`([^`]+)`", text)


def table(page: str, heads: str) -> list[list[str]]:
    """The cells of the rows below a table's head."""
    rows = page.split(heads)[1].split("\n\n")[0].strip().split("\n")[1:]
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]


def statement(code: str) -> str:
    """Code of the page as it may stand in a function."""
    return code if code.endswith(";") else f"static_cast<void>({code});"


class SnippetsTest(unittest.TestCase):
    """One program of all that the page shows."""

    def setUp(self) -> None:
        text = PAGE.read_text(encoding="utf-8")
        self.page = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
        self.helpers = table(self.page, "| for | with | in |")

    def test_helpers_are_where_the_page_says(self) -> None:
        for _, code, places in self.helpers:
            files = []
            for name in spans(places):
                kind = "geometry " if places.startswith("geometry") else ""
                files.append(SOURCE / HEADERS[kind] / name)
            text = "".join(file.read_text(encoding="utf-8") for file in files)
            for snippet in spans(code):
                for name in re.findall(r"(?<![.\w])([A-Za-z_]\w*)(?: \w+)?\(", snippet):
                    with self.subTest(name=name, files=files):
                        self.assertRegex(text, rf"\b{name}\b")

    def test_all_is_compiled_and_the_helpers_run(self) -> None:
        self.assertGreater(len(self.helpers), 15)
        program = [f'#include "routebench/planning/{header}.hpp"' for header in ("plugin", "planner")]
        for folder in HEADERS.values():
            for header in sorted((SOURCE / folder).glob("*.hpp")):
                name = "/".join(header.parts[-3:])
                if f"`{header.name}`" in self.page:
                    program.append(f'#include "{name}"')
        program += ["#include <cstdio>", AT_HAND]

        types = table(self.page, "| type | what it is |")
        self.assertGreater(len(types), 5)
        for (name,), members in ((spans(row[0]), spans(row[1])) for row in types):
            uses = " ".join(f"static_cast<void>(thing.{member});" for member in members)
            program.append(f"[[maybe_unused]] void look_at({name}& thing) {{ {uses} }}")

        (plan,) = {code for code in spans(self.page) if code.startswith("Route plan(")}
        (register,) = {code for code in spans(self.page) if code.startswith("ROUTEBENCH_REGISTER")}
        program.append(
            "class Class final : public Planner {\n public:\n"
            "  struct Params { void bind(ParamBinder&) {} };\n"
            '  static PlannerInfo info() { return {"class", PlannerRole::kFill, "none", "none"}; }\n'
            f"  explicit Class(const Params&) {{}}\n  {plan} override {{ return {{}}; }}\n}};"
        )
        program.append(register)

        program.append("int main() {")
        for number, (_, code, _) in enumerate(self.helpers):
            body = " ".join(statement(snippet) for snippet in spans(code))
            program.append(f"  struct Row{number} : AtHand {{ auto run() {{ {body} }} }};")
            program.append(f'  static_cast<void>(Row{number}().run()), std::puts("{number}");')
        program.append("}")
        with tempfile.TemporaryDirectory() as folder:
            source, binary = Path(folder) / "page.cpp", Path(folder) / "page"
            source.write_text("\n".join(program) + "\n", encoding="utf-8")
            words = [COMPILER, "-std=c++20", "-Wall", "-Wextra", "-Wno-unused", "-Wno-unused-result"]
            words += ["-ffp-contract=off", str(source)]
            for module in ("geometry", "planners"):
                words += ["-I", str(SOURCE / module / "include")]
                words += ["-I", str(BUILD / module / "include")]
            sanitized = os.environ.get("ROUTEBENCH_SANITIZE")
            if sanitized:
                words.append("-fsyntax-only")
            else:
                libraries = BUILD / "lib"
                words += ["-o", str(binary), "-L", str(libraries), f"-Wl,-rpath,{libraries}"]
                words += ["-lroutebench_planning", "-lroutebench_geometry"]
            built = subprocess.run(words, capture_output=True, text=True, check=False)
            self.assertEqual(built.returncode, 0, built.stderr)
            if sanitized:
                return
            done = subprocess.run([binary], capture_output=True, text=True, check=False, timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout.split(), [str(n) for n in range(len(self.helpers))])


if __name__ == "__main__":
    unittest.main()
