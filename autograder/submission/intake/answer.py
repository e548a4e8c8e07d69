"""Finds the answer in a submission: the notebook and the source tree that count.

If a submission contains several candidates, the one whose answers include the answers of all others counts. So an
edited copy always wins over an untouched release. If two candidates have different answers, the submission is unclear.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TypeVar

from autograder import course_paths
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.submission.intake.exercises import SOURCE, Exercises, is_stub
from autograder.submission.intake.files import SkippedFile, SubmittedFile, unsafe
from autograder.submission.intake.names import is_notebook, names_assignment
from autograder.submission.intake.notebooks import Cell, read_cells
from autograder.submission.intake.writefile import same_text, written_file

MANIFEST = "package.xml"
_NAME = re.compile(rb"<name>\s*([A-Za-z]\w{0,60})\s*</name>")

Answers = Mapping[str, str]


@dataclass(frozen=True)
class Tree:
    """A source tree, a folder with packages in it."""

    folder: PurePosixPath  # the folder with the packages, such as `ws/src`
    root: PurePosixPath  # the assignment's folder, which contains `folder`
    packages: frozenset[PurePosixPath]  # the folders of its packages if only they belong to it; else empty
    files: Mapping[PurePosixPath, SubmittedFile]
    answers: Answers

    def contains(self, path: PurePosixPath) -> bool:
        """Return whether a file of the submission belongs to the tree."""
        return not (self.packages or {self.folder}).isdisjoint((path, *path.parents))


@dataclass(frozen=True)
class Notebook:
    """A notebook: its file, its cells and its answers. `broken` is the reason why it cannot be read, or empty."""

    file: SubmittedFile
    cells: tuple[Cell, ...]
    answers: Answers
    broken: str = ""

    @property
    def root(self) -> PurePosixPath:
        """The folder that contains the notebook."""
        return self.file.path.parent


@dataclass(frozen=True)
class Answer:
    """The part of a submission that counts. The notebook or the tree may be missing, and the notebook may be broken."""

    notebook: Notebook | None
    tree: Tree | None


def find_answer(
    files: Sequence[SubmittedFile], skipped: Sequence[SkippedFile], assignment: str, exercises: Exercises | None
) -> Answer:
    """Find the answer among the files of a submission.

    Raises:
        StudentError: the submission contains no answer, one that cannot be read, or several different ones.
    """
    trees = _trees(files, assignment, exercises)
    notebooks = _notebooks(files, trees, assignment, exercises)
    readable, broken = [n for n in notebooks if not n.broken], [n for n in notebooks if n.broken]
    roots = {notebook.root for notebook in readable}
    tree = _choose(
        trees, lambda tree: (tree.root not in roots, len(tree.folder.parts), str(tree.folder)), "source trees"
    )
    for file in skipped:
        if _is_needed(file.path, tree):
            raise unsafe(file.sentence)
    is_complete = tree is not None and exercises is not None and exercises.is_complete(_contents_of(tree))

    def preference(notebook: Notebook) -> tuple[bool, bool, int, str]:
        path = notebook.file.path
        return (
            tree is not None and notebook.root != tree.root,
            path.name != f"{assignment}.ipynb",
            len(path.parts),
            str(path),
        )

    if is_complete and readable:
        return Answer(min(readable, key=preference), tree)
    notebook = _choose(readable, preference, "notebooks")
    is_edited = (tree is not None and tree.answers) or (notebook is not None and notebook.answers)
    if broken and not is_complete and not (notebook is not None and notebook.answers):
        raise StudentError(Diagnosis(Kind.UNREADABLE, broken_sentence(broken[0])))
    possible_answer = next((file for file in skipped if file.may_contain_answer), None)
    if not is_edited and possible_answer is not None:
        raise StudentError(Diagnosis(Kind.UNREADABLE, f"{possible_answer.sentence}."))
    if notebook is None and tree is None:
        if skipped:
            raise unsafe(skipped[0].sentence)
        sentence = (
            f"There is nothing to grade: neither {assignment}.ipynb nor a ws/src folder with a package. Hand in the "
            "assignment's whole folder."
        )
        raise StudentError(Diagnosis(Kind.NOTHING_SUBMITTED, sentence))
    return Answer(notebook or (broken[0] if broken else None), tree)


def broken_sentence(notebook: Notebook) -> str:
    """Return why a notebook cannot be read, and how to fix it."""
    name = notebook.file.path
    return (
        f"{name} cannot be read as a notebook ({notebook.broken}): open it in JupyterLab, save it and hand it in again."
    )


def _is_needed(path: PurePosixPath, tree: Tree | None) -> bool:
    """Return whether a skipped file belongs to the source tree, or may be the folder of a source tree."""
    if tree is not None:
        return path.is_relative_to(tree.folder)
    return path.name in ("ws", "src") or "src" in path.parts


Candidate = TypeVar("Candidate", Tree, Notebook)


def _choose(candidates: Sequence[Candidate], preference: Callable[[Candidate], object], label: str) -> Candidate | None:
    """Return the candidate that counts, or None without candidates. Raises StudentError if several could count."""
    fullest = [c for c in candidates if not any(c.answers.items() < other.answers.items() for other in candidates)]
    different = [c for c in fullest if c.answers != fullest[0].answers]
    if different:
        outermost = min(fullest, key=lambda c: len(c.root.parts))
        other_candidates = [c for c in fullest if c.answers != outermost.answers]
        if not all(c.root != outermost.root and c.root.is_relative_to(outermost.root) for c in other_candidates):
            names = sorted({str(c.file.path if isinstance(c, Notebook) else c.folder) for c in fullest})
            sentence = (
                f"The submission is unclear: it holds {len(names)} {label} with different answers, "
                f"{', '.join(names[:5])}. Hand in the one that counts, without the others."
            )
            raise StudentError(Diagnosis(Kind.UNCLEAR, sentence))
        fullest = [c for c in fullest if c.answers == outermost.answers]
    return min(fullest, key=preference, default=None)  # type: ignore[arg-type]


def _trees(files: Sequence[SubmittedFile], assignment: str, exercises: Exercises | None) -> list[Tree]:
    """Return the source trees, one for each assignment folder: its `ws/src`, or else `src`, or else its packages."""
    paths = {file.path for file in files}
    folders: dict[PurePosixPath, PurePosixPath] = {}
    for path in sorted(paths):
        folder = _source_folder(path.parts)
        if folder is not None and folder.parent / MANIFEST not in paths:
            root = folder.parents[1] if folder.parts[-2:] == ("ws", "src") else folder.parent
            if root not in folders or folder.parts[-2:] == ("ws", "src"):
                folders[root] = folder
    package = PurePosixPath()
    packages = {path.parent for path in paths if path.name == MANIFEST} if not folders else set()
    outer = frozenset(package for package in packages if not packages.intersection(package.parents))
    if packages:
        if outer == {PurePosixPath()}:
            package = _package_name(next(file.data for file in files if str(file.path) == MANIFEST))
            folders = {PurePosixPath(): PurePosixPath()} if package.parts else {}
        else:
            folders = {package.parent: package.parent for package in outer}
    other_assignments = set(course_paths.assignments()) - {assignment}
    files_of: dict[PurePosixPath, list[SubmittedFile]] = {folder: [] for folder in folders.values()}
    for file in files:
        if not outer or outer.intersection(file.path.parents):
            for folder in files_of.keys() & set(file.path.parents):
                files_of[folder].append(file)
    trees = []
    for root, folder in folders.items():
        if other_assignments.intersection(folder.parts):
            continue
        tree_files = {
            (p := package / file.path.relative_to(folder)): SubmittedFile(p, file.data, file.executable)
            for file in files_of[folder]
        }
        trees.append(Tree(folder, root, outer, tree_files, _tree_answers(tree_files, exercises)))
    chapter_packages = exercises.packages if exercises is not None else frozenset()
    return [tree for tree in trees if chapter_packages.intersection(path.parts[0] for path in tree.files)] or trees


def _source_folder(parts: tuple[str, ...]) -> PurePosixPath | None:
    """Return the folder of packages that contains a file: the first `ws/src` of its path, or else the first `src`."""
    for index in range(len(parts) - 2):
        if parts[index : index + 2] == ("ws", "src"):
            return PurePosixPath(*parts[: index + 2])
    if "src" in parts[:-1]:
        return PurePosixPath(*parts[: parts.index("src") + 1])
    return None


def _package_name(manifest: bytes) -> PurePosixPath:
    match = _NAME.search(manifest[:65536])
    return PurePosixPath(match[1].decode()) if match else PurePosixPath()


def _tree_answers(files: Mapping[PurePosixPath, SubmittedFile], exercises: Exercises | None) -> Answers:
    """Return a digest of each file that differs from the released one."""
    return {
        str(path): hashlib.sha256(file.data.replace(b"\r\n", b"\n")).hexdigest()
        for path, file in files.items()
        if exercises is None or not exercises.is_as_released(path, file.data)
    }


def _notebooks(
    files: Sequence[SubmittedFile], trees: Sequence[Tree], assignment: str, exercises: Exercises | None
) -> list[Notebook]:
    """Return the notebooks whose names or cells are the assignment's, or else those that match no assignment."""
    folders = {tree.folder for tree in trees if tree.folder.parts}
    by_name, by_cells, unassigned = [], [], []
    for file in files:
        if not is_notebook(file.path.name) or folders.intersection((file.path, *file.path.parents)):
            continue
        notebook, has_chapter_cell = _read_notebook(file, exercises)
        if names_assignment(file.path.name, assignment):
            by_name.append(notebook)
        elif has_chapter_cell:
            by_cells.append(notebook)
        elif not any(names_assignment(file.path.name, other) for other in course_paths.assignments()):
            unassigned.append(notebook)
    return by_name + by_cells or unassigned


def _read_notebook(file: SubmittedFile, exercises: Exercises | None) -> tuple[Notebook, bool]:
    """Return a notebook, and whether one of its cells comes from the chapter."""
    try:
        cells = tuple(read_cells(file.data))
    except ValueError as error:
        return Notebook(file, (), {}, str(error)[:200]), False
    if exercises is None:
        return Notebook(file, cells, {"": hashlib.sha256(file.data).hexdigest()}), False
    answers: dict[str, str] = {}
    has_chapter_cell = False
    for cell in cells:
        written, name = written_file(cell["source"]), exercises.grade_id(cell)
        target = None
        if written is not None and written[0].is_relative_to(SOURCE):
            target = written[0].relative_to(SOURCE)
        if written is not None and target is not None and target in exercises.targets:
            has_chapter_cell = True
            if not is_stub(written[1], exercises.targets[target]):
                answers[str(target)] = written[1].strip()
        elif name in exercises.answers:
            has_chapter_cell = True
            if not same_text(cell["source"], exercises.answers[name]):
                answers[name] = cell["source"].strip()
        elif name in exercises.locked:
            has_chapter_cell = True
    return Notebook(file, cells, answers), has_chapter_cell


def _contents_of(tree: Tree) -> dict[PurePosixPath, bytes]:
    return {path: file.data for path, file in tree.files.items()}
