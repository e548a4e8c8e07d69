"""Every chapter runs to its end, solved and as released, and follows the rules for notebooks."""

from __future__ import annotations

import ast
import re
import runpy
import subprocess
import sys
from pathlib import Path, PurePosixPath
from xml.etree import ElementTree

import pytest
import yaml
from _pytest.mark import ParameterSet

from autograder.author.course.execute import run_notebook
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter, chapters
from autograder.course_paths import ROOT
from autograder.submission.intake.exercises import SOURCE, exercises_of
from autograder.submission.intake.writefile import written_file
from autograder.suite import suites
from tests.notebooks.alternative_texts import images_without_alt
from tests.notebooks.outputs import text_of

CHAPTERS = chapters()
STILL_TO_BE_WRITTEN = "still to be written"
SOLUTION_MARKERS = ("# BEGIN SOLUTION", "# END SOLUTION")
each_chapter = pytest.mark.parametrize("chapter", CHAPTERS, ids=lambda chapter: chapter.assignment)


def test_course_check_reports_nothing() -> None:
    process = subprocess.run(
        [sys.executable, "-m", "autograder", "course", "check"], cwd=ROOT, text=True, capture_output=True
    )
    assert (process.returncode, process.stdout) == (0, ""), process.stdout + process.stderr


@each_chapter
def test_a_release_contains_no_line_of_its_answers(chapter: Chapter) -> None:
    source, released = chapter.read(), in_form(chapter.read(), Form.RELEASED)
    for before, after in zip(source.cells, released.cells, strict=True):
        for answer in re.findall(r"# BEGIN SOLUTION\n(.*?)# END SOLUTION", before.source, re.DOTALL):
            assert answer.rstrip() not in after.source


@each_chapter
def test_a_release_folds_the_code_of_its_grade_cells_and_of_no_other(chapter: Chapter) -> None:
    cells = in_form(chapter.read(), Form.RELEASED).cells
    folded = [cell.id for cell in cells if cell.metadata.get("jupyter", {}).get("source_hidden")]
    assert folded == [cell.id for cell in cells if cell.source.startswith("grade(")]


@each_chapter
def test_no_text_mentions_the_printed_chapter(chapter: Chapter) -> None:
    texts = [cell.source for cell in chapter.read().cells]
    assert [text for text in texts if re.search(r"\b[Tt]he (printed )?chapter\b", text)] == []


@each_chapter
def test_the_textbook_is_mentioned_only_if_the_welcome_introduces_it(chapter: Chapter) -> None:
    is_introduced = "call this book *the textbook*" in " ".join(CHAPTERS[0].read().cells[-1].source.split())
    assert is_introduced or not any("textbook" in cell.source for cell in chapter.read().cells)


@each_chapter
def test_a_given_package_installs_only_executables_that_exist_in_the_chapter(chapter: Chapter) -> None:
    written_files = {cell.source.split()[1] for cell in chapter.read().cells if cell.source.startswith("%%writefile")}
    modules = {str(path.relative_to(chapter.folder)) for path in chapter.folder.glob("ws/src/**/*.py")} | written_files
    for setup in chapter.folder.glob("ws/src/*/setup.py"):
        scripts = re.findall(r"'\w+ = ([\w.]+):main'", setup.read_text())
        assert scripts
        for script in scripts:
            module = setup.parent.relative_to(chapter.folder) / (script.replace(".", "/") + ".py")
            assert str(module) in modules


def meaning(cell: str) -> object:
    """Return the meaning of a code cell or of the file that it writes: Python, YAML, XML or lines with `#` comments."""
    magic, _, body = cell.partition("\n")
    suffix = Path(magic).suffix if magic.startswith("%%writefile ") else ".py"
    if suffix == ".py":
        return ast.dump(ast.parse(body if magic.startswith("%%writefile ") else cell))
    if suffix == ".yaml":
        return yaml.safe_load(body)
    if suffix == ".xml":
        return [(element.tag, element.attrib, text(element)) for element in ElementTree.fromstring(body).iter()]
    return [line for line in body.split("\n") if not line.startswith("#")]


def text(element: ElementTree.Element) -> str:
    """Return an element's own text; the text of an element with children is ignored."""
    return "" if len(element) else (element.text or "")


@each_chapter
def test_a_solved_notebook_is_the_source_without_the_comments_around_its_answers(chapter: Chapter) -> None:
    """So the source runs like a student's solved notebook, and only one of the two needs a run."""
    source, solved = chapter.read(), in_form(chapter.read(), Form.SOLVED)
    assert len(source.cells) == len(solved.cells)
    for before, after in zip(source.cells, solved.cells, strict=True):
        assert {**before, "source": ""} == {**after, "source": ""}
        if before.cell_type == "code" and before.source != after.source:
            lines = [line for line in before.source.split("\n") if line.strip() not in SOLUTION_MARKERS]
            assert after.source.split("\n") == lines
            assert meaning(after.source) == meaning(before.source)


def runs() -> list[ParameterSet]:
    """Return a run of each notebook with its answers, and of its release."""
    return [
        pytest.param(chapter, form, id=f"{form.value}-{chapter.assignment}")
        for form in (Form.SOURCE, Form.RELEASED)
        for chapter in CHAPTERS
    ]


@pytest.mark.promise("The tests execute the notebooks and grade some of the submissions with a known mark.")
@pytest.mark.slow
@pytest.mark.timeout(1200)  # takes half a minute on an idle machine; the limit ends a kernel that hangs
@pytest.mark.parametrize(("chapter", "form"), runs())
def test_a_chapter_runs_to_its_end_without_a_warning(chapter: Chapter, form: Form, tmp_path: Path) -> None:
    packages = tmp_path / "src"
    result = run_notebook(chapter, form, timeout=400, report=tmp_path / "report.ipynb", packages=packages)
    assert result.ok, result.failure
    if form is Form.SOURCE:
        assert undeclared_files(chapter, packages) == set()
    assert images_without_alt(result.notebook) == []
    counts = re.findall(r"(\d+) of (\d+) visible checks passed", text_of(result.notebook.cells))
    solved = form is not Form.RELEASED
    assert all((passed == total) is solved for passed, total in counts)
    if counts:
        assert (STILL_TO_BE_WRITTEN in text_of(result.notebook.cells)) is not solved


def undeclared_files(chapter: Chapter, packages: Path) -> set[str]:
    """Return the answer's files that the notebook created and that neither `%%writefile` nor the metadata name."""
    exercises = exercises_of(chapter.assignment)
    assert exercises is not None
    graded = [name for name in suites.graded_assignments() if name == chapter.assignment]
    sources = suites.hidden(chapter.assignment).sources if graded else ()
    written_files = {file[0] for cell in chapter.read().cells if (file := written_file(cell.source)) is not None}
    undeclared = set()
    for path in (path for source in sources for path in (packages / source).rglob("*") if path.is_file()):
        name = PurePosixPath(path.relative_to(packages))
        given_files = exercises.given.get(name)
        if name not in exercises.makes and SOURCE / name not in written_files:
            undeclared |= {str(name)} if given_files is None or given_files.data != path.read_bytes() else set()
    return undeclared


def drawing(figure: Path) -> str:
    """Return an SVG file without the digests in its identifiers, which differ between versions of numpy."""
    return re.sub(r"\b[mp][0-9a-f]{10}\b", "id", figure.read_text(encoding="utf-8"))


@pytest.mark.parametrize("script", sorted(ROOT.glob("assets/figures/*/make.py")), ids=lambda path: path.parent.name)
def test_a_chapters_figures_are_up_to_date_with_their_script(script: Path, tmp_path: Path) -> None:
    runpy.run_path(str(script))["main"](tmp_path)
    figures = ROOT / "chapters" / script.parent.name / "figures"
    names = {path.name for path in figures.iterdir()}
    assert names == {path.name for path in tmp_path.iterdir()}
    for name in names:
        assert drawing(figures / name) == drawing(tmp_path / name), f"{name} is stale: run {script.relative_to(ROOT)}"


@each_chapter
def test_cells_that_write_python_files_write_valid_python(chapter: Chapter) -> None:
    for form in Form:
        for cell in in_form(chapter.read(), form).cells:
            if re.match(r"%%writefile \S+\.py\n", cell.source):
                assert ast.parse(cell.source.split("\n", 1)[1]).body
