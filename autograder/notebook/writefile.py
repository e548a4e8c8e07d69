"""The course's `%%writefile`, which writes a file like IPython's but never destroys a student's work.

It creates missing folders and prints their names, because a misspelt name also creates one. A cell that still
contains an exercise's stub does not replace a file that the student wrote in another way. A file that was changed since
a cell last wrote it is copied to `replaced/` in its workspace before a cell replaces it.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from IPython.core import magic_arguments
from IPython.core.interactiveshell import InteractiveShell
from IPython.display import display

from autograder.exceptions import UsageError
from autograder.notebook.notices import Notice
from autograder.notebook.written_record import RECORD, digest, read_record
from autograder.result.model import write_json

STUB = "YOUR CODE HERE"  # the placeholder for an answer in a released cell
REPLACED = "replaced"


def register(shell: InteractiveShell | None) -> None:
    """Replace the shell's `%%writefile` with the course's. Without a shell, do nothing. Safe to call twice."""
    if shell is None:
        return
    untyped_shell: Any = shell  # IPython has no type annotations
    original = untyped_shell.find_cell_magic("writefile")
    if original is None or getattr(original, "is_course_magic", False):
        return

    def writefile(line: str, cell: str) -> None:
        write(line, cell, original)

    writefile.is_course_magic = True  # type: ignore[attr-defined]
    untyped_shell.register_magic_function(writefile, "cell")


def write(line: str, cell: str, original: Any) -> None:
    """Write a cell's text to the file named by `line`, unless that would destroy a student's work.

    If the record of the last written texts is lost, a needless copy is made, but no work is lost. `line` is the text
    after `%%writefile`, and `original` is IPython's own magic, which writes the file and prints a message.
    """
    parse: Any = magic_arguments.parse_argstring
    arguments = parse(original, line)
    path = Path(arguments.filename.strip("'\"")).expanduser()
    workspace = _find_workspace(path)
    record, name, on_disk = read_record(workspace), os.path.relpath(path, workspace), _read_text(path)
    _make_folder(path.parent)
    if arguments.append:
        original(line, cell)
        if on_disk is None or record.get(name) == digest(on_disk):  # only cells have written the file
            write_json(workspace / RECORD, {**record, name: digest((on_disk or "") + cell)})
        return
    if on_disk is not None and on_disk != cell:
        if cell.count(STUB) > on_disk.count(STUB):
            _show(
                f"{path} was kept as it is: the file contains your text, but this cell contains the exercise's stub. "
                "To start again from the stub, delete the file and run the cell."
            )
            return
        if record.get(name) != digest(on_disk):
            _show(f"{path} was changed outside of this cell. Its old text was copied to {_keep_copy(path, workspace)}.")
    original(line, cell)
    write_json(workspace / RECORD, {**record, name: digest(cell)})


def _make_folder(folder: Path) -> None:
    """Create a folder if it does not exist, and print its name. Raises UsageError if part of its path is a file."""
    if folder.is_dir():
        return
    try:
        folder.mkdir(parents=True)
    except (FileExistsError, NotADirectoryError):
        parts = (folder, *folder.parents)
        file = next(part for part in parts if part.exists())
        raise UsageError(f"{file} is a file, so the folder {folder} cannot be created: rename one of them") from None
    print(f"Created the folder {folder}")


def _show(sentence: str) -> None:
    show: Any = display
    show(Notice(sentence))


def _find_workspace(path: Path) -> Path:
    """Return the workspace `ws` that contains a file, or the file's folder."""
    return next((folder for folder in path.parents if folder.name == "ws"), path.parent)


def _read_text(path: Path) -> str | None:
    if not path.is_file():
        return None
    return path.read_bytes().decode("utf-8", "surrogateescape")


def _keep_copy(path: Path, workspace: Path) -> Path:
    """Copy a file to an unused name in the workspace's folder of replaced files, and return the copy's path."""
    folder = workspace / REPLACED
    base = folder / os.path.relpath(path, workspace)
    base.parent.mkdir(parents=True, exist_ok=True)
    (folder / "COLCON_IGNORE").touch()  # a copied package.xml must not count as a package
    number = 1
    while (copy := base.with_name(f"{base.name}.{number}")).exists():
        number += 1
    copy.write_bytes(path.read_bytes())
    return copy
