"""Every path, command and make target that the documents name exists."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import click
import pytest

from autograder.cli import group

ROOT = Path(__file__).parents[3]
DOCUMENTS = (
    "README.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "CHANGELOG.md",
    *(f"docs/{p.name}" for p in ROOT.glob("docs/*.md")),
)
FOLDERS = sorted(path.name for path in ROOT.iterdir() if path.is_dir())
MADE = (".build/", ".venv", "made/")  # created by commands
MADE_PAGES = {path.name.replace("_page.py", ".md") for path in ROOT.glob("docs/*_page.py")}  # by `make docs`
IN_A_CHAPTER = ("ws/src", "support/contract.py", "hidden/conftest.py")  # paths in a chapter's folder


def spans(document: str) -> list[str]:
    """Return the code in a document: spans in a line, and each line of a block."""
    text = (ROOT / document).read_text(encoding="utf-8")
    blocks = re.findall(r"```\w*\n(.*?)```", text, flags=re.DOTALL)
    inline = re.sub(r"```\w*\n.*?```", "", text, flags=re.DOTALL)
    lines = [line.split("  #")[0].removeprefix("$ ") for block in blocks for line in block.splitlines()]
    return [" ".join(span.split()) for span in re.findall(r"`([^`]+)`", inline)] + lines


def paths(document: str) -> set[str]:
    """Return the paths that a document names: relative links, and words of code with a slash or a file's ending."""
    text = (ROOT / document).read_text(encoding="utf-8")
    links = {link.partition("#")[0] for link in re.findall(r"\]\(([^)\s]+)\)", text) if "://" not in link}
    words = {word.rstrip("/") for span in spans(document) for word in span.split() if _is_path(word)}
    drawn = set(re.findall(r'\.save\("([\w.]+)"\)', text))  # by the page's own code, when the site is built
    return {link for link in links - drawn if link} | words


def _is_path(word: str) -> bool:
    first = word.split("/")[0]
    return ("/" in word and first in FOLDERS) or bool(re.fullmatch(r"[\w.-]+\.(md|toml|lock)", word))


def commands(document: str) -> list[list[str]]:
    """Return the words of each call of `autograder` after its name."""
    matches = [re.match(r"(?:eval \"\$\()?(?:\.venv/bin/)?autograder ([^`)]*)", span) for span in spans(document)]
    return [match[1].split() for match in matches if match]


@pytest.mark.parametrize("document", DOCUMENTS)
def test_each_path_that_a_document_names_exists(document: str) -> None:
    named = {path for path in paths(document) if not path.startswith(MADE) and path not in IN_A_CHAPTER}
    folders = (ROOT, (ROOT / document).parent)
    missing = {path for path in named if not any(any(folder.glob(path)) for folder in folders)}
    assert missing <= {"package.xml", "setup.py", *MADE_PAGES}


def test_the_documents_name_paths() -> None:
    assert len(paths("CONTRIBUTING.md")) > 40
    assert len(commands("README.md")) > 4


@pytest.mark.parametrize("document", DOCUMENTS)
def test_each_command_that_a_document_names_exists(document: str) -> None:
    for words in commands(document):
        command: click.Command = group
        context = click.Context(group)
        while words and isinstance(command, click.Group) and not words[0].startswith("-"):
            subcommand = command.get_command(context, words[0])
            assert subcommand is not None, f"{document}: autograder {' '.join(words)}"
            command, words = subcommand, words[1:]
        options = {name for parameter in command.params for name in parameter.opts} | {"--version", "--help"}
        used = {word for word in words if re.fullmatch(r"--?[a-z]+", word)} if command.name != "ros" else set()
        assert used <= options, f"{document}: {command.name} has no {used - options}"


def test_each_make_target_that_a_document_names_exists() -> None:
    targets_text = subprocess.run(["make", "-s", "help"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    targets = {*re.findall(r"make ([a-z-]+)", targets_text), "lint"}
    for document in DOCUMENTS:
        named = {match[1] for span in spans(document) if (match := re.match(r"make (?:\w+=\S+ )?([a-z-]+)", span))}
        assert named <= targets, document


def table(heading: str) -> list[list[str]]:
    """Return the rows of the first table below a heading of CONTRIBUTING.md, without its head."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").split(f"## {heading}\n")[1].split("\n## ")[0]
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("|")]
    return rows[2:]


def test_the_listed_fixtures_are_those_of_the_plug_in() -> None:
    source = (ROOT / "autograder/grade/plugin.py").read_text(encoding="utf-8")
    fixtures = set(re.findall(r"@pytest\.fixture.*\n    def (\w+)", source))
    assert {row[0].strip("`") for row in table("Fixtures")} == fixtures != set()
