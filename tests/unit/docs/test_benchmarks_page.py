"""The page of benchmarks describes every figure of `make bench`, and shows what was measured and on which machine."""

from __future__ import annotations

import re
import runpy
from fnmatch import fnmatch

from autograder.course_paths import ROOT
from autograder.suite import suites

SCRIPT = runpy.run_path(str(ROOT / "docs" / "benchmarks_page.py"))
FIGURES, page = SCRIPT["FIGURES"], SCRIPT["page"]
COMPARED = {
    value for figure in FIGURES.values() for value in figure.get("beside", {}).values() if isinstance(value, str)
}
DESCRIBED = {*FIGURES, *COMPARED}


def patterns() -> set[str]:
    """Return the names of figures in the modules of benchmarks, with a star for what a name inserts."""
    parts = "|".join(sorted({name.partition(".")[0] for name in DESCRIBED if "." in name}))
    name = re.compile(rf'"((?:{parts})\.[\w{{}}\[\]:]+|first_robots_s)"')
    texts = [path.read_text(encoding="utf-8") for path in (ROOT / "tests" / "benchmarks").glob("bench_*.py")]
    return {re.sub(r"{.*?}", "*", figure) for text in texts for figure in name.findall(text)}


def test_the_page_describes_the_figures_of_the_benchmarks_and_no_others() -> None:
    assert {pattern for pattern in patterns() if not any(fnmatch(name, pattern) for name in DESCRIBED)} == set()
    assert {name for name in DESCRIBED if not any(fnmatch(name, pattern) for pattern in patterns())} == set()


def test_the_page_describes_a_figure_for_the_grading_of_each_reference() -> None:
    assert {f"grade.{assignment[:2]}_core_s" for assignment in suites.graded_assignments()} <= set(FIGURES)


def test_the_page_shows_figures_the_machine_and_the_figures_of_other_programs() -> None:
    figures = {"sim.scan360_numpy_us": 49.6123, "sim.scan360_irsim_us": 1234.5}
    text = page({"figures": figures, "machine": {"processor": "Z80", "cores": 2}})
    assert "on this machine: processor Z80, cores 2." in text
    assert "| 49.6 µs | ir-sim: 1,234 µs; shapely (STRtree): 2,559 µs\\* |" in text


def test_each_figure_of_another_program_is_a_name_or_a_number() -> None:
    values = [value for figure in FIGURES.values() for value in figure.get("beside", {}).values()]
    assert values
    assert [value for value in values if not isinstance(value, str | int | float)] == []


def test_the_page_without_a_record_says_so_and_lists_the_figures() -> None:
    text = page(SCRIPT["NO_RECORD"])
    assert "without that file" in text
    assert all(f"| `{name}` |" in text for name in FIGURES)
