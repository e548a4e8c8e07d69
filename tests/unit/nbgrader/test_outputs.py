"""Outputs below the cells of an autograded notebook, and the points that nbgrader reads from them."""

from __future__ import annotations

import base64
import re
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import nbformat
import pytest
from hypothesis import given
from hypothesis import strategies as st
from nbconvert import HTMLExporter
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_raw_cell
from nbgrader.utils import determine_grade

from autograder.lms.nbgrader.outputs import grade_outputs, sanitized_outputs
from autograder.lms.nbgrader.restore import MAX_CELL, MAX_CELLS, restored
from autograder.lms.nbgrader.sanitizing import sanitized_markdown
from autograder.report.feedback.model import PageView, page_view
from autograder.result.model import Artifact, CheckResult, Result
from autograder.suite import Check, Outcome

TEXT = st.text(st.sampled_from("ab <>'&\x00\x1b[31m\udcff\ud800é\n"), max_size=20)
JSON = st.recursive(
    st.none() | st.booleans() | st.floats(allow_nan=False) | TEXT,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXT, inner, max_size=3),
    max_leaves=6,
)
OUTPUT = st.fixed_dictionaries(
    {"output_type": st.sampled_from(["stream", "error", "display_data", "execute_result", "update", None])},
    optional={
        "name": JSON,
        "text": JSON,
        "ename": JSON,
        "evalue": JSON,
        "traceback": JSON,
        "metadata": JSON,
        "data": JSON
        | st.dictionaries(st.sampled_from(["text/plain", "text/html", "image/png", "image/svg+xml"]), JSON, max_size=4),
    },
)


@pytest.mark.fuzz
@pytest.mark.slow
@given(st.lists(OUTPUT, max_size=4))
def test_any_outputs_of_a_kernel_become_valid_and_harmless(outputs: list[dict[str, Any]]) -> None:
    sanitized = sanitized_outputs(outputs)
    nbformat.validate(new_notebook(cells=[new_code_cell("", outputs=sanitized)]))
    for output in sanitized:
        assert set(output.get("data", {})) <= {"text/plain", "image/png", "image/jpeg"}
        assert output.get("metadata", {}) == {}
        str(output).encode("utf-8")


def test_only_colours_are_kept_of_terminal_codes_and_not_thousands_of_them() -> None:
    def text(printed: str) -> str:
        (output,) = sanitized_outputs([{"output_type": "stream", "name": "stdout", "text": printed}])
        return str(output.text)

    assert text("\x1b[1;31mred\x1b[0m \x1b[2K\x1b[Aup \x1b") == "\x1b[1;31mred\x1b[0m up "
    assert text("\x1b[31mred" * 1001) == "red" * 1001
    assert text(f"\x1b[{'1;' * 1000}mbold").startswith("[1;1;")


def test_text_colours_and_pictures_are_kept() -> None:
    png = base64.b64encode(b"\x89PNG picture").decode()
    stream, picture, error = sanitized_outputs(
        [
            {"output_type": "stream", "name": "stderr", "text": ["a\x1b[31m", "b"]},
            {"output_type": "display_data", "data": {"image/png": png + "\n", "text/html": "<b>", "text/plain": "p"}},
            {"output_type": "error", "ename": "E", "evalue": "v", "traceback": ["line"]},
        ]
    )
    assert (stream.name, stream.text) == ("stderr", "a\x1b[31mb")
    assert picture.data == {"image/png": png, "text/plain": "p"}
    assert (error.ename, error.evalue, error.traceback) == ("E", "v", ["line"])


@pytest.fixture
def page(make_result: Callable[..., Result], track: Callable[..., Artifact], tmp_path: Path) -> PageView:
    return page_view(make_result(artifacts=(track(tmp_path),)), tmp_path)


@pytest.mark.parametrize("points", [0.0, 1.0, 1 / 3, 4.0, 1e-7])
def test_nbgrader_records_exactly_the_points_of_a_verdict(points: float, page: PageView) -> None:
    cell = new_code_cell("pass", outputs=grade_outputs(points, page, page.groups[1], first=True))
    cell.metadata.nbgrader = {"grade": True, "solution": False, "points": 4, "grade_id": "g"}
    assert determine_grade(cell) == (points, 4.0)
    assert [output.output_type for output in cell.outputs].count("execute_result") == 1


def test_a_verdict_shows_its_pictures_with_alternative_texts(page: PageView) -> None:
    picture = grade_outputs(1.0, page, page.groups[1], first=False)[-1]
    assert picture.metadata["image/png"]["alt"] == "The robot's track: it touches the north wall at t = 12.4 s."
    assert base64.b64decode(picture.data["image/png"]).startswith(b"\x89PNG")


def test_consequences_are_folded_under_their_cause_and_named_in_their_own_cell(
    make_result: Callable[..., Result], make_check: Callable[..., Check]
) -> None:
    first, same, other = (
        make_check(id, f"It is {id}.", 1.0, group, after=after)
        for id, group, after in (("first", "a", ()), ("same", "a", ("first",)), ("other", "b", ("first",)))
    )
    checks = tuple(CheckResult.of(check, Outcome.FAILED, f"{check.id} is wrong") for check in (first, same, other))
    page = page_view(make_result(checks=checks, max_score=3.0), None)
    cells = [grade_outputs(0, page, group, first=False)[1].data for group in page.groups]
    assert cells[0]["text/plain"].splitlines() == [
        "[failed] It is first. first is wrong",
        "These also failed. Fix the one above first, then run again:",
        "[failed] It is same. same is wrong",
        "[failed] It is other. other is wrong",
    ]
    assert "Fix the one above first, then run again: 2</summary>" in cells[0]["text/html"]
    assert cells[1]["text/plain"] == "1 check did not pass with: It is first."
    assert "1 check did not pass with “It is first.” (1 points)" in cells[1]["text/html"]


def test_the_first_verdict_also_shows_the_diagnosis(broken_result: Result) -> None:
    page = page_view(broken_result, None)
    first, other = (grade_outputs(0, page, page.groups[0], first=first)[1].data["text/html"] for first in (True, False))
    assert "The package does not build: setup.py line 3." in first
    assert "SyntaxError: oops" in first
    assert "does not build" not in other


@pytest.mark.parametrize(
    ("markdown", "expected", "removed"),
    [
        ("# Head\n\n**bold** `code`", "<strong>bold</strong> <code>code</code>", "&lt;"),
        ("|a|\n|-|\n|1|", "<td>1</td>", "&lt;"),
        ("[site](https://ros.org)", 'href="https://ros.org"', "&lt;"),
        ("![a track](track.png)", 'alt="a track"', "&lt;"),
        ("<script>x</script>", "&lt;script&gt;", "<script"),
        ("a <img src=x onerror=y()>", '<img src="x">', "onerror"),
        ("![x](http://host.example/x.png)", '<img alt="x">', "host.example"),
        ("a <img src='http://host.example/x' alt=b>", '<img alt="b">', "host.example"),
        ("a <img src='//host.example/x'>", "<img>", "host.example"),
        ("a <img src='\\\\host.example/x'>", "<img>", "host.example"),
        ("a <img src='h\tttp://host.example/x'>", "<img>", "host.example"),
        ("a <img src='/hub/logout'>", "<img>", "logout"),
        ("a <img src='../../x?y'>", "<img>", "src="),
        ("a <img srcset='http://host.example/x'>", "<img>", "host.example"),
        ("<link rel=stylesheet href=http://host.example/x>", "&lt;link", "<link"),
        ("<style>@import 'http://host.example/x'</style>", "&lt;style", "<style"),
        ("<video src=http://host.example/x></video>", "&lt;video", "<video"),
        ("<table background=http://host.example/x><tr><td>y</td></tr></table>", "<table>", "host.example"),
        (r"$\style{background:url(http://host.example/x)}{y}$", "y", r"\style"),
        (r"$\csname style\endcsname{y}$", "y", r"\csname"),
        (r"$\mmlToken{mi}[href=http://host.example/x]{y}$", "y", r"\mmlToken"),
        ("[x](javascript:y)", "<a>x</a>", "javascript"),
        ("<iframe src=x></iframe>", "&lt;iframe", "<iframe"),
        ("<form action=x><button>ok</button></form>", "&lt;form", "<form"),
        ("<p style='position:fixed'>x</p>", "<p>x</p>", "style"),
        ("<svg onload=y()></svg>", "&lt;svg", "<svg"),
    ],
)
def test_markdown_keeps_its_structure_and_loses_active_content(markdown: str, expected: str, removed: str) -> None:
    html = sanitized_markdown(None, markdown)  # type: ignore[arg-type]
    assert expected in html
    assert removed not in html


class Loaded(HTMLParser):
    """Collects the addresses that a page loads automatically."""

    def __init__(self) -> None:
        super().__init__()
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Collect each attribute that may hold an address, except in links, which load only on a click."""
        self.addresses += [
            f"{tag} {name}={value}" for name, value in attrs if tag != "a" and "host.example" in (value or "")
        ]


@pytest.mark.parametrize("template", ["classic", "lab"])
def test_a_page_of_a_students_cells_requests_nothing_from_other_hosts(template: str) -> None:
    attack = "<img src=http://host.example/1><style>@import 'http://host.example/2'</style>"
    cells = [new_markdown_cell(attack), new_raw_cell(attack, metadata={"raw_mimetype": "text/html"})]
    notebook = restored(new_notebook(cells=[*cells, new_code_cell(f"'{attack}'")]), new_notebook())
    notebook.cells[-1].outputs = sanitized_outputs(
        [
            {"output_type": "stream", "name": "stdout", "text": attack},
            {"output_type": "display_data", "data": {"text/html": attack, "text/plain": attack}},
        ]
    )
    filters = {"markdown2html": sanitized_markdown}
    exporter = HTMLExporter(template_name=template, filters=filters)  # type: ignore[no-untyped-call]
    html, _ = exporter.from_notebook_node(notebook)
    assert html.count("host.example") > 5
    page = Loaded()
    page.feed(html)
    assert page.addresses == []
    assert not re.search(r"<style>[^<]*host\.example", html)


def rendered(notebook: nbformat.NotebookNode) -> str:
    filters = {"markdown2html": sanitized_markdown}
    html, _ = HTMLExporter(filters=filters).from_notebook_node(notebook)  # type: ignore[no-untyped-call]
    return str(html)


@pytest.mark.parametrize("new_cell", [new_markdown_cell, new_raw_cell, new_code_cell], ids=["Markdown", "raw", "code"])
def test_a_very_long_cell_of_a_student_is_cut_and_shown_as_plain_text(
    new_cell: Callable[..., nbformat.NotebookNode],
) -> None:
    """A cell of 16 MB kept nbgrader's feedback and formgrader busy for days."""
    source = "%%bash\n" + "# <b>x</b> **y**\n" * (MAX_CELL // 10)
    notebook = restored(new_notebook(cells=[new_cell(source)]), new_notebook())
    assert len(notebook.cells[0].source) < 1.5 * MAX_CELL
    html = rendered(notebook)
    assert f"This cell has {len(source):,} characters. Here are the first 20,000." in html
    assert "The submitted notebook contains all." in html
    body = html[html.index("This cell has") :]
    assert not re.search(r"<(?:b|strong|h1|span class)\b", body)
    assert "# &lt;b&gt;x&lt;/b&gt; **y**" in body


def test_usual_cells_and_those_of_the_instructor_are_not_cut() -> None:
    given = [new_markdown_cell("*given* " * MAX_CELL), new_code_cell("given = 1\n" * MAX_CELL)]
    own = [new_markdown_cell("x" * MAX_CELL), new_code_cell("y" * MAX_CELL)]
    notebook = restored(new_notebook(cells=[*given, *own]), new_notebook(cells=given))
    assert [cell.source for cell in notebook.cells] == [cell.source for cell in (*given, *own)]


def test_a_further_copy_of_a_given_cell_counts_as_the_student_s() -> None:
    given = new_markdown_cell("*given* " * MAX_CELL)
    notebook = restored(new_notebook(cells=[given, new_markdown_cell(given.source)]), new_notebook(cells=[given]))
    assert notebook.cells[0].source == given.source
    assert "This cell has" in notebook.cells[1].source


def test_all_cells_of_a_student_together_are_limited() -> None:
    cells = [new_markdown_cell(f"{number} " + "\\begin{a}" * (MAX_CELL // 10)) for number in range(100)]
    notebook = restored(new_notebook(cells=cells), new_notebook())
    sources = [cell.source for cell in notebook.cells]
    assert sources[:5] == [cell.source for cell in cells[:5]]
    assert all("Here are the first 200." in source for source in sources[6:])
    assert sum(map(len, sources)) < 1.5 * MAX_CELLS
