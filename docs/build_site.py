"""Builds the site from the pages in `docs`. `make docs` first executes the notebooks, and then tests the site.

Some pages are generated: the chapters as students get them, with the outputs of their last run in .build/notebooks, the
run on the start page, the table of the verification, and the pages of the modules named *_page.py. The environment
variable SITE_ADDRESS contains the address of the site, which previews of its links need.
"""

from __future__ import annotations

import math
import re
import runpy
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import nbformat
import numpy as np
from matplotlib.figure import Figure
from matplotlib.image import imread

from autograder import course_paths
from autograder.author.course.forms import Form, in_form
from autograder.author.course.markdown_table import table
from autograder.author.course.sync import Chapter, chapters
from autograder.author.verification.cases import cases
from autograder.author.verification.mutants import mutants
from autograder.author.verification.verdicts import CaseKind
from autograder.suite import suites
from sim import Command, RobotSpec, Scan, Simulation, State, load_world, run
from sim.export import to_html

DOCS = course_paths.ROOT / "docs"
SITE = course_paths.BUILD / "site"
SOURCE, HTML = SITE / "source", SITE / "html"
NOT_COPIED = ("cluster", "*.py", "__pycache__")
# The robot on the start page turns when an obstacle is nearer than ROOM (m) and within AHEAD (rad) of its heading.
AHEAD, ROOM = math.radians(50.0), 0.6
FOLDER_OF_A_LINK = re.compile(r"\]\((?:docs|\.\./chapters)/")
OTHER_PAGES = ("CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "chapters/ros2-commands.md", "chapters/glossary.md")
ROBOT = course_paths.ROOT / "assets" / "figures" / "robot.png"
EXAMPLE = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
ENTRY = re.compile(r"^(?P<words>[^\n:]+)\n: (?P<text>.+(?:\n  .+)*)", re.MULTILINE)
# Parts of a page without prose: code, headings, links and pictures, tables, choices of a question, tags.
NOT_PROSE = re.compile(
    r"^(?P<fence>```|~~~).*?^(?P=fence)|`[^`]*`|^#.*?$|!?\[[^\]]*\]\([^)]*\)|^\|.*?$|^- \w\) .*?$|<[^>]*>",
    re.MULTILINE | re.DOTALL,
)
GUIDES = (
    "students.md",
    "instructors.md",
    "authors.md",
    "first_check.md",
    "first_launch_check.md",
    "trust.md",
    "troubleshooting.md",
    "index.md",
)
# Terms that are not linked, because they have another meaning: on all pages (ordinary verbs), or on one page (the
# actions of a launch file, packages of pip).
NEVER_LINKED = {"Build", "Source"}
NOT_LINKED_ON = {"04_launch": {"Action"}, "05_parameters": {"Action"}, "students": {"Package"}}


def build(screenshots: Path) -> subprocess.CompletedProcess[str]:
    """Write the sources of the site and run Sphinx, with warnings as errors. The site is in `HTML`.

    Args:
        screenshots: the folder with the pictures that the guides show.
    """
    shutil.rmtree(SITE, ignore_errors=True)
    shutil.copytree(DOCS, SOURCE, ignore=shutil.ignore_patterns(*NOT_COPIED))
    shutil.copy(DOCS / "conf.py", SOURCE)
    for script in DOCS.glob("*_page.py"):
        text = runpy.run_path(str(script))["current"]()
        (SOURCE / script.name.replace("_page.py", ".md")).write_text(text, encoding="utf-8")
    for name in OTHER_PAGES:
        shutil.copy(course_paths.ROOT / name, SOURCE)
    for page in SOURCE.glob("*.md"):  # the site has all pages in one folder
        page.write_text(FOLDER_OF_A_LINK.sub("](", page.read_text(encoding="utf-8")), encoding="utf-8")
    words = write_glossary(SOURCE / "glossary.md")
    for name in GUIDES:
        guide = SOURCE / name
        (linked_text,) = link_first_uses([guide.read_text(encoding="utf-8")], linked_terms(words, guide.stem))
        guide.write_text(linked_text, encoding="utf-8")
    shutil.copytree(screenshots, SOURCE / "made")
    (SOURCE / "chapters").mkdir()
    for chapter in chapters():
        write_chapter(chapter, SOURCE / "chapters", words)
    (SOURCE / "made" / "verification.md").write_text(verification_table(), encoding="utf-8")
    write_run(SOURCE / "_extra" / "run.html")
    write_preview(SOURCE / "_extra" / "preview.png")
    shutil.copy(course_paths.WORLDS / "doorway.yaml", SOURCE / "api")
    for name in ("api/sim.md", "simulator.md"):
        run_examples(SOURCE / name)
    sphinx = [sys.executable, "-m", "sphinx", "-b", "html", "-q", "-W", "--keep-going", "-d", str(SITE / "doctrees")]
    return subprocess.run([*sphinx, str(SOURCE), str(HTML)], capture_output=True, text=True, check=False)


def write_glossary(page: Path) -> frozenset[str]:
    """Convert a page's list of definitions to a Sphinx glossary. Return its terms."""
    text, words = page.read_text(encoding="utf-8"), set()
    for entry in list(ENTRY.finditer(text)):
        names = entry["words"].split(", ")
        words.update(names)
        text = text.replace(entry[0], "```{glossary}\n" + "\n".join(names) + f"\n  {entry['text']}\n```")
    page.write_text(text, encoding="utf-8")
    return frozenset(words)


def linked_terms(words: frozenset[str], page: str) -> set[str]:
    """Return the terms of the glossary that a page uses in the same meaning."""
    return set(words - NEVER_LINKED - NOT_LINKED_ON.get(page, set()))


def link_first_uses(texts: Sequence[str], words: set[str]) -> list[str]:
    """Return a page's texts, in which the first use of each word in prose is a link to the glossary."""
    linked_texts = []
    for text in texts:
        for word in sorted(words, key=len, reverse=True):
            excluded_spans = [match.span() for match in NOT_PROSE.finditer(text)]
            pattern = r"\s+".join(map(re.escape, word.split()))
            for occurrence in re.finditer(rf"\b{pattern}s?\b", text, re.IGNORECASE):
                if not any(occurrence.start() < stop and start < occurrence.end() for start, stop in excluded_spans):
                    text_of_link = " ".join(occurrence[0].split())
                    text = f"{text[: occurrence.start()]}{{term}}`{text_of_link} <{word}>`{text[occurrence.end() :]}"
                    words = words - {word}
                    break
        linked_texts.append(text)
    return linked_texts


def write_chapter(chapter: Chapter, folder: Path, words: frozenset[str] = frozenset()) -> None:
    """Write a chapter's notebook as students get it, with the outputs of its last run unless it has changed since.

    The title begins with the chapter's number. Below the title is a link to the notebook itself, in the folder
    `notebooks` beside `folder`. The first use of each of the words is a link to the glossary.
    """
    notebook = in_form(chapter.read(), Form.RELEASED)
    downloads = folder.parent / "notebooks"
    downloads.mkdir(exist_ok=True)
    nbformat.write(notebook, downloads / chapter.notebook_path.name)
    report = course_paths.BUILD / "notebooks" / f"{chapter.assignment}-{Form.RELEASED.value}.ipynb"
    if report.is_file():
        executed_notebook = nbformat.read(report, as_version=nbformat.NO_CONVERT)
        if [cell.source for cell in executed_notebook.cells] == [cell.source for cell in notebook.cells]:
            notebook = executed_notebook
    prose = [cell for cell in notebook.cells if cell.cell_type == "markdown"]
    linked_texts = link_first_uses([cell.source for cell in prose], linked_terms(words, chapter.assignment))
    for cell, text in zip(prose, linked_texts, strict=True):
        cell.source = text
    if prose:
        prose[0].source = with_number(prose[0].source, chapter.assignment)
    nbformat.write(notebook, folder / chapter.notebook_path.name)
    if (chapter.folder / "figures").is_dir():
        shutil.copytree(chapter.folder / "figures", folder / "figures", dirs_exist_ok=True)


def with_number(text: str, assignment: str) -> str:
    """Return the first cell of a chapter with the chapter's number in its title, and a link to its notebook below."""
    title, _, rest = text.partition("\n")
    numbered_title = title.replace("# ", f"# {int(assignment.partition('_')[0])}. ", 1)
    link = f"{{download}}`Download the notebook <../notebooks/{assignment}.ipynb>`"
    return f"{numbered_title}\n\n{link}. It runs in the [folder of the course](../students.md).\n{rest}"


def verification_table() -> str:
    """Return a Markdown table with the numbers of test cases for each suite."""
    rows = []
    for name in suites.graded_assignments():
        suite = suites.hidden(name)
        variants = sum(case.kind is CaseKind.VARIANT for case in cases(name, quick=True))
        counts = (len(suite.checks), len(mutants(name)), variants)
        rows.append((name, f"{suite.max_score:g}", *map(str, counts)))
    return "\n".join(table(("chapter", "points", "hidden checks", "named mutants", "variants"), rows))


def write_run(path: Path) -> None:
    """Write the page with the run that the start page shows: a robot wanders through the lab by its lidar."""
    path.parent.mkdir(parents=True)
    simulation = Simulation(load_world(course_paths.WORLDS / "lab.yaml"), (RobotSpec(),))
    to_html(run(simulation, wander, seconds=40.0), path)


def write_preview(path: Path) -> None:
    """Draw the picture that previews of links show: 1200 x 630 pixels with the title and the README's robot."""
    robot = imread(ROBOT)
    figure = Figure(figsize=(12.0, 6.3), facecolor="white")
    figure.figimage(robot, 1200 - robot.shape[1] - 24, (630 - robot.shape[0]) // 2)
    figure.text(
        0.04, 0.5, "Building\nROS 2 packages\nwith Python", size=28, weight="bold", va="bottom", linespacing=1.3
    )
    figure.text(0.04, 0.45, "Ten notebooks, a robot\nwith a lidar, an autograder", size=17, va="top", linespacing=1.5)
    figure.savefig(path, dpi=100)


def run_examples(page: Path) -> None:
    """Run the Python code of a page as one program in the page's folder. It draws the page's pictures.

    Raises:
        subprocess.CalledProcessError: the code failed.
    """
    code = "\n".join(EXAMPLE.findall(page.read_text(encoding="utf-8")))
    subprocess.run([sys.executable, "-c", code], cwd=page.parent, check=True)


def wander(state: State, scans: dict[str, Scan | None]) -> Command:
    """Drive if there is room ahead, and otherwise turn to the side with more room."""
    (scan,) = scans.values()
    assert scan is not None, "the robot has a lidar"
    bearings = (
        np.remainder(scan.angle_min + np.arange(len(scan.ranges)) * scan.angle_increment + np.pi, math.tau) - np.pi
    )
    left, right = (
        np.min(scan.ranges, where=(side * bearings > 0) & (abs(bearings) < AHEAD), initial=math.inf) for side in (1, -1)
    )
    if min(left, right) > ROOM:
        return Command(linear=0.3)
    return Command(angular=0.8 if left >= right else -0.8)
