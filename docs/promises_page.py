"""The page `promises.md`: which test shows each promise of the README and the guides.

A test says what it shows by `@pytest.mark.promise("words of a sentence")`. `python docs/promises_page.py` prints the
page.
"""

from __future__ import annotations

import ast
import re
import runpy
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from autograder.author.course.markdown_table import table
from autograder.layout import ROOT

PAGES = (
    "README.md",
    *(f"docs/{name}.md" for name in ("index", "students", "instructors", "authors", "first_check", "troubleshooting")),
    *(f"docs/{name}.md" for name in ("first_launch_check", "lms", "cluster", "platform", "limits")),
)
HEAD = """# Promises and their tests

What the README and the guides say that the course does, and the tests that show it. `make nightly` runs the tests that
are called nightly, and `make test` all others. The pages about attacks and limits name their tests themselves.
"""
# Figures that `make bench` measures are no promises.
COMMAND = r"(?:\.venv/bin/)?(?:autograder|make|nbgrader|dask|pip)\b(?!/| bench\b)|eval \""
# A sentence or a row of a table needs a test if it has a command, an option or an exit status, or says "never".
PROMISING = re.compile(rf"(?:^|`)(?:{COMMAND})|`--[a-z]|\bexit status\b|\bends with (?:status )?1\b|\bnever\b")
BLOCK = re.compile(r"^```(?P<kind>\w*).*?\n(?P<text>.*?)^```\n?", re.MULTILINE | re.DOTALL)
SENTENCE = re.compile(r"(?<!^\d\.)(?<=[.?!])\s+(?=[A-Z`\"\[])")

# A link, of which the text is shown, and what begins an item of a list.
MARKUP = re.compile(r"!?\[([^\]]*)\]\([^)]*\)|^(?:-|\d\.) ")


@dataclass(frozen=True)
class Promise:
    """Words of a page, and the test that shows that they are true, as `file::name`."""

    words: str
    test: str
    is_nightly: bool


def texts() -> dict[str, str]:
    """Return the text of each page. Some are made by a module beside them."""
    return {
        page: str(runpy.run_path(str(script))["current"]())
        if (script := ROOT / page.replace(".md", "_page.py")).is_file()
        else (ROOT / page).read_text(encoding="utf-8")
        for page in PAGES
    }


def sentences(text: str) -> list[str]:
    """Return the sentences and the rows of tables of a page, and the commands in its blocks of code."""
    commands = [
        line.removeprefix("$ ").partition("  #")[0].strip()
        for block in BLOCK.finditer(text)
        if block["kind"] == "console"
        for line in block["text"].splitlines()
        if re.match(rf"\$ (?:{COMMAND})", line)
    ]
    prose = [
        _on_one_line(sentence)
        for part in re.split(r"\n\s*\n|\n(?=\s*(?:[-|]|\d\.) )|\n(?=#)", BLOCK.sub("\n\n", text))
        for sentence in ([part] if part.startswith("|") else SENTENCE.split(part))
    ]
    return [sentence for sentence in prose if sentence] + commands


def is_promise(sentence: str) -> bool:
    """Return whether a sentence has to have a test."""
    return bool(PROMISING.search(sentence))


def promises() -> Iterator[Promise]:
    """Yield the promises that tests are marked with. The tests are parsed and not imported."""
    for path in sorted((ROOT / "tests").rglob("test_*.py")):
        source = path.read_text(encoding="utf-8")
        if "mark.promise(" in source:
            yield from _promises_of(path.relative_to(ROOT), ast.parse(source))


def _promises_of(path: Path, tree: ast.Module) -> Iterator[Promise]:
    module_is_nightly = any(
        isinstance(node, ast.Assign)
        and ast.unparse(node.targets[0]) == "pytestmark"
        and "pytest.mark.nightly" in ast.unparse(node.value)
        for node in tree.body
    )
    for function in (node for node in tree.body if isinstance(node, ast.FunctionDef)):
        marks = [ast.unparse(decorator) for decorator in function.decorator_list]
        is_nightly = module_is_nightly or "pytest.mark.nightly" in marks
        for decorator in function.decorator_list:
            if isinstance(decorator, ast.Call) and ast.unparse(decorator.func) == "pytest.mark.promise":
                for words in decorator.args:
                    yield Promise(ast.literal_eval(words), f"{path.as_posix()}::{function.name}", is_nightly)


def current() -> str:
    """Return the page."""
    held = list(promises())
    parts = [HEAD]
    for page, text in texts().items():
        rows = []
        for sentence in sentences(text):
            tests = [f"`{one.test}`" + " (nightly)" * one.is_nightly for one in held if one.words in sentence]
            if tests:
                shown = MARKUP.sub(r"\1", sentence.strip("| ")).replace("|", "·")
                rows.append((shown, "; ".join(sorted(set(tests)))))
        parts += [f"## {page}\n", *table(("promise", "shown by"), rows)]
    return "\n".join(parts)


def _on_one_line(text: str) -> str:
    return " ".join(text.split())


if __name__ == "__main__":
    print(current())
