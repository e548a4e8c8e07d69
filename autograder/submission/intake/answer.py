"""Finds the answer in a submission: the notebook and the source tree that count, if there may be several.

A candidate counts if its answers hold those of each other one: an untouched release never wins over an edited copy, and
of equal ones either counts. Where two candidates answer differently, the submission is unclear.
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
from autograder.submission.intake.files import LeftOut, SubmittedFile, unsafe
from autograder.submission.intake.names import is_notebook, names_assignment
from autograder.submission.intake.notebooks import Cell, read_cells
from autograder.submission.intake.writefile import same_text, written_file

MANIFEST = "package.xml"
_NAME = re.compile(rb"<name>\s*([A-Za-z]\w{0,60})\s*</name>")

Answers = Mapping[str, str]


@dataclass(frozen=True)
class Tree:
    """A source tree: the folder whose entries are packages, the folder of the submission, and its files."""

    home: PurePosixPath
    root: PurePosixPath
    packages: frozenset[PurePosixPath]  # the folders of packages, where these alone belong to it
    files: Mapping[PurePosixPath, SubmittedFile]
    answers: Answers

    def holds(self, path: PurePosixPath) -> bool:
        """Return whether a file of the submission is in it."""
        return not (self.packages or {self.home}).isdisjoint((path, *path.parents))


@dataclass(frozen=True)
class Notebook:
    """A notebook: its file, its cells, and its answers. `broken` says why it cannot be read."""

    file: SubmittedFile
    cells: tuple[Cell, ...]
    answers: Answers
    broken: str = ""

    @property
    def root(self) -> PurePosixPath:
        """Its folder."""
        return self.file.path.parent


@dataclass(frozen=True)
class Answer:
    """The part of a submission that counts. Either may be missing; `broken` is a notebook that cannot be read."""

    notebook: Notebook | None
    tree: Tree | None


def find_answer(
    files: Sequence[SubmittedFile], left_out: Sequence[LeftOut], assignment: str, exercises: Exercises | None
) -> Answer:
    """Find the answer among the files of a submission.

    Raises:
        StudentError: it has none, it cannot be read, or two candidates answer differently.
    """
    trees = _trees(files, assignment, exercises)
    notebooks = _notebooks(files, trees, assignment, exercises)
    readable, broken = [n for n in notebooks if not n.broken], [n for n in notebooks if n.broken]
    roots = {notebook.root for notebook in readable}
    tree = _only(trees, lambda tree: (tree.root not in roots, len(tree.home.parts), str(tree.home)), "source trees")
    for each in left_out:
        if _is_needed(each.path, tree):
            raise unsafe(each.sentence)
    whole = tree is not None and exercises is not None and exercises.is_whole(_data(tree))

    def preference(notebook: Notebook) -> tuple[bool, bool, int, str]:
        path = notebook.file.path
        return (
            tree is not None and notebook.root != tree.root,
            path.name != f"{assignment}.ipynb",
            len(path.parts),
            str(path),
        )

    if whole and readable:
        return Answer(min(readable, key=preference), tree)
    notebook = _only(readable, preference, "notebooks")
    edited = (tree is not None and tree.answers) or (notebook is not None and notebook.answers)
    if broken and not whole and not (notebook is not None and notebook.answers):
        raise StudentError(Diagnosis(Kind.UNREADABLE, broken_sentence(broken[0])))
    doubtful = next((each for each in left_out if each.may_hold_answer), None)
    if not edited and doubtful is not None:
        raise StudentError(Diagnosis(Kind.UNREADABLE, f"{doubtful.sentence}."))
    if notebook is None and tree is None:
        if left_out:
            raise unsafe(left_out[0].sentence)
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
    """Return whether an unread file belongs to the source tree, or hides it."""
    if tree is not None:
        return path.is_relative_to(tree.home)
    return path.name in ("ws", "src") or "src" in path.parts


C = TypeVar("C", Tree, Notebook)


def _only(candidates: Sequence[C], preference: Callable[[C], object], what: str) -> C | None:
    """Return the candidate that counts, or None. Raises StudentError if several could."""
    fullest = [c for c in candidates if not any(c.answers.items() < other.answers.items() for other in candidates)]
    different = [c for c in fullest if c.answers != fullest[0].answers]
    if different:
        outermost = min(fullest, key=lambda c: len(c.root.parts))
        others = [c for c in fullest if c.answers != outermost.answers]
        if not all(c.root != outermost.root and c.root.is_relative_to(outermost.root) for c in others):
            names = sorted({str(c.file.path if isinstance(c, Notebook) else c.home) for c in fullest})
            sentence = (
                f"The submission is unclear: it holds {len(names)} {what} with different answers, "
                f"{', '.join(names[:5])}. Hand in the one that counts, without the others."
            )
            raise StudentError(Diagnosis(Kind.UNCLEAR, sentence))
        fullest = [c for c in fullest if c.answers == outermost.answers]
    return min(fullest, key=preference, default=None)  # type: ignore[arg-type]


def _trees(files: Sequence[SubmittedFile], assignment: str, exercises: Exercises | None) -> list[Tree]:
    """Return the source trees, one for each folder: `ws/src` in it, or else `src`, or else its packages."""
    paths = {file.path for file in files}
    homes: dict[PurePosixPath, PurePosixPath] = {}
    for path in sorted(paths):
        home = _home(path.parts)
        if home is not None and home.parent / MANIFEST not in paths:
            root = home.parents[1] if home.parts[-2:] == ("ws", "src") else home.parent
            if root not in homes or home.parts[-2:] == ("ws", "src"):
                homes[root] = home
    virtual = PurePosixPath()
    packages = {path.parent for path in paths if path.name == MANIFEST} if not homes else set()
    outer = frozenset(package for package in packages if not packages.intersection(package.parents))
    if packages:
        if outer == {PurePosixPath()}:
            virtual = _package_name(next(file.data for file in files if str(file.path) == MANIFEST))
            homes = {PurePosixPath(): PurePosixPath()} if virtual.parts else {}
        else:
            homes = {package.parent: package.parent for package in outer}
    others = set(course_paths.assignments()) - {assignment}
    below: dict[PurePosixPath, list[SubmittedFile]] = {home: [] for home in homes.values()}
    for file in files:
        if not outer or outer.intersection(file.path.parents):
            for home in below.keys() & set(file.path.parents):
                below[home].append(file)
    trees = []
    for root, home in homes.items():
        if others.intersection(home.parts):
            continue
        inside = {
            (p := virtual / file.path.relative_to(home)): SubmittedFile(p, file.data, file.executable)
            for file in below[home]
        }
        trees.append(Tree(home, root, outer, inside, _tree_answers(inside, exercises)))
    own = exercises.packages if exercises is not None else frozenset()
    return [tree for tree in trees if own.intersection(path.parts[0] for path in tree.files)] or trees


def _home(parts: tuple[str, ...]) -> PurePosixPath | None:
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
    """Return a digest of each file that is not as it was released."""
    return {
        str(path): hashlib.sha256(file.data.replace(b"\r\n", b"\n")).hexdigest()
        for path, file in files.items()
        if exercises is None or not exercises.is_as_released(path, file.data)
    }


def _notebooks(
    files: Sequence[SubmittedFile], trees: Sequence[Tree], assignment: str, exercises: Exercises | None
) -> list[Notebook]:
    """Return the notebooks of the assignment, by name or by cells, or all notebooks if none matches."""
    homes = {tree.home for tree in trees if tree.home.parts}
    named, alike, others = [], [], []
    for file in files:
        if not is_notebook(file.path.name) or homes.intersection((file.path, *file.path.parents)):
            continue
        notebook, is_of_chapter = _read(file, exercises)
        if names_assignment(file.path.name, assignment):
            named.append(notebook)
        elif is_of_chapter:
            alike.append(notebook)
        elif not any(names_assignment(file.path.name, other) for other in course_paths.assignments()):
            others.append(notebook)
    return named + alike or others


def _read(file: SubmittedFile, exercises: Exercises | None) -> tuple[Notebook, bool]:
    """Return a notebook, and whether a cell of it is one of the chapter's exercises."""
    try:
        cells = tuple(read_cells(file.data))
    except ValueError as error:
        return Notebook(file, (), {}, str(error)[:200]), False
    if exercises is None:
        return Notebook(file, cells, {"": hashlib.sha256(file.data).hexdigest()}), False
    answers: dict[str, str] = {}
    is_of_chapter = False
    for cell in cells:
        written, name = written_file(cell["source"]), exercises.grade_id(cell)
        target = None
        if written is not None and written[0].is_relative_to(SOURCE):
            target = written[0].relative_to(SOURCE)
        if written is not None and target is not None and target in exercises.targets:
            is_of_chapter = True
            if not is_stub(written[1], exercises.targets[target]):
                answers[str(target)] = written[1].strip()
        elif name in exercises.answers:
            is_of_chapter = True
            if not same_text(cell["source"], exercises.answers[name]):
                answers[name] = cell["source"].strip()
        elif name in exercises.locked:
            is_of_chapter = True
    return Notebook(file, cells, answers), is_of_chapter


def _data(tree: Tree) -> dict[PurePosixPath, bytes]:
    return {path: file.data for path, file in tree.files.items()}
