"""Finds files of an answer that differ from the cells that write them. `check` warns of them: the files are graded."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path, PurePosixPath

from autograder.notebook.written_record import digest, read_record
from autograder.submission.exercise_stubs import STILL_TO_BE_WRITTEN
from autograder.submission.intake.counting import difference_notice
from autograder.submission.intake.exercises import SOURCE, text_of
from autograder.submission.intake.names import is_notebook, names_assignment
from autograder.submission.intake.notebooks import read_cells
from autograder.submission.intake.writefile import same_text, written_file


def differences(
    assignment: str, workspace: Path, packages: Sequence[str], later: Collection[str] = ()
) -> tuple[str, ...]:
    """Return a sentence for each file that differs from its cell.

    The saved notebook may be older than the cells on the screen. It is therefore compared only with files that no cell
    has written since the notebook was saved.

    Args:
        assignment: the name of the chapter.
        workspace: the workspace, with `src`. The notebook is beside it.
        packages: the folders of `src` to compare.
        later: files that are not compared, because they belong to a later exercise.
    """
    notebook = _find_notebook(workspace.resolve().parent, assignment)
    cells = {} if notebook is None else _written_texts(notebook)
    record = {PurePosixPath(name): value for name, value in read_record(workspace).items()}
    last_digests = {path.relative_to("src"): value for path, value in record.items() if path.is_relative_to("src")}
    sentences = []
    compared_files = [path for path in cells.keys() | last_digests.keys() if str(SOURCE / path) not in later]
    for path in sorted(p for p in compared_files if p.parts and p.parts[0] in packages):
        file, cell, last_digest = workspace / "src" / path, cells.get(path), last_digests.get(path)
        is_answered = cell is not None and STILL_TO_BE_WRITTEN not in cell
        if not file.is_file():
            if is_answered:
                sentences.append(f"{SOURCE / path} is missing: run the cell that writes it.")
            continue
        text = text_of(file.read_bytes())
        if cell is not None and same_text(cell, text):
            continue
        if last_digest is not None and last_digest != digest(text):  # the file has changed since a cell wrote it
            is_stub = cell is not None and not is_answered and digest(cell) == last_digest
            sentences += [] if is_stub else [difference_notice(path)]
        elif is_answered and notebook is not None:
            is_stale = last_digest is not None and notebook.stat().st_mtime <= file.stat().st_mtime
            sentences += [] if is_stale else [difference_notice(path)]
    return tuple(sentences)


def _find_notebook(folder: Path, assignment: str) -> Path | None:
    """Return the path of the assignment's notebook in a folder, even if the notebook was renamed, or None."""
    default_path = folder / f"{assignment}.ipynb"
    if default_path.is_file():
        return default_path
    renamed_notebooks = [p for p in folder.iterdir() if is_notebook(p.name) and names_assignment(p.name, assignment)]
    return renamed_notebooks[0] if len(renamed_notebooks) == 1 else None


def _written_texts(notebook: Path) -> dict[PurePosixPath, str]:
    """Return the files that the cells of a notebook write to `ws/src`. The last cell that writes a file counts."""
    try:
        cells = read_cells(notebook.read_bytes())
    except (OSError, ValueError):
        return {}
    files = (written_file(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    return {path.relative_to(SOURCE): text for path, text in filter(None, files) if path.is_relative_to(SOURCE)}
