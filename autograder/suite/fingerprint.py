"""The version of a suite, and a digest of all files that a grading reads.

Two gradings of a submission with the same seed and the same version give the same mark. `autograder grade --resume`
relies on this. A version consists of a digest of the chapter's files and of the files that its suite names in `READS`,
and of `GRADER_VERSION` for everything else.

The digest of all files changes with every comment. The verification of the grader and the machines of a cluster, which
need more than the same mark, use it.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from autograder import course_paths

# The version of the grader and the simulator, which the checks of all chapters use. Raise it by one with each change
# that can give a submission another mark with the same seed, or another reason for its mark: see CONTRIBUTING.md.
# `--resume` grades submissions again whose results have another version.
GRADER_VERSION = 11

# Parts of the autograder that no grading reads.
NOT_READ = frozenset(
    {
        *("author", "bootstrap.py", "checking/attacks.py", "cli", "doctor", "grade/cluster", "lms", "notebook"),
        *("report", "result/causes.py"),
    }
)
# Files in a chapter's checks that only the verification reads.
VERIFICATION = frozenset(
    {"attack_payloads.py", "attacks.py", "mutants.snapshot.yaml", "mutants.yaml", "survivors.yaml", "variants"}
)
CHECKS_IMPORT = re.compile(r"\bautograder\.checks\.(ch\d[\w.]+)(?: import (\([\w\s,]+\)|[^\n#]+))?")


def version(assignment: str, reads: Iterable[str] = ()) -> str:
    """Return the version of an assignment's suite: `GRADER_VERSION`, a dash and 12 hexadecimal digits.

    Args:
        assignment: name of the assignment.
        reads: files and folders that its checks read besides their own, as paths in the course's folder.
    """
    return f"{GRADER_VERSION}-{_digest(chapter_files(assignment, reads))}"


def digest(assignment: str, reads: Iterable[str] = ()) -> str:
    """Return a digest of all files that a grading reads: 12 hexadecimal digits. The arguments are as in `version`."""
    return _digest(files(assignment, reads))


def files(assignment: str, reads: Iterable[str] = ()) -> list[Path]:
    """Return the sorted paths of all files that a grading reads. The arguments are as in `version`."""
    root = course_paths.ROOT
    shared = _files_below(root, (root / name for name in ("autograder", "sim", "assets/worlds")))
    read_by_all = (path for path in shared if _is_read(path.relative_to(root).parts))
    course = course_paths.course()
    return sorted(
        {*read_by_all, *_files_below(course.root, (course.root / course.worlds,)), *chapter_files(assignment, reads)}
    )


def chapter_files(assignment: str, reads: Iterable[str] = ()) -> list[Path]:
    """Return the sorted paths of all files that only a chapter's gradings read. The arguments are as in `version`."""
    return sorted(_files_below(course_paths.course().root, suite_paths(assignment, reads)))


def _digest(paths: Iterable[Path]) -> str:
    """Return a digest of the names and contents of files, as 12 hexadecimal digits."""
    sha256 = hashlib.sha256()
    for path in paths:
        name = path.relative_to(
            course_paths.course().root if path.is_relative_to(course_paths.course().root) else course_paths.ROOT
        )
        sha256.update(f"{name}\0{path.stat().st_size}\0".encode() + path.read_bytes())
    return sha256.hexdigest()[:12]


def suite_paths(
    assignment: str, reads: Iterable[str] = (), *, parts: Iterable[str] = ("visible", "hidden")
) -> list[Path]:
    """Return the files and folders of the course that only the gradings of one assignment read.

    They are its checks without the files for verification, the modules of other chapters' checks that its checks
    import, its notebook, the packages that it gives to students, and the files that its suite names in `READS`.

    Args:
        assignment: name of the assignment.
        reads: files and folders that its checks read besides their own, as paths in the course's folder.
        parts: the suites to include.
    """
    course = course_paths.course()
    checks, chapter = course.root / course.checks, course.root / course.chapters / assignment
    suite = checks / f"ch{assignment}"
    unread_names = VERIFICATION | {"__pycache__"} | {"visible", "hidden"}.difference(parts)
    own_paths = [path for path in suite.iterdir() if path.name not in unread_names] if suite.is_dir() else []
    released_paths = (chapter / f"{assignment}.ipynb", chapter / "ws" / "src")
    candidates = [
        *own_paths,
        *_imported_modules(own_paths, checks),
        *released_paths,
        *(course.root / name for name in reads),
    ]
    return sorted({path for path in candidates if path.exists()})


def _files_below(root: Path, top_paths: Iterable[Path]) -> Iterator[Path]:
    """Yield the files at or below some paths, except those that tools create."""
    for path in (path for top in top_paths for path in (top, *top.rglob("*")) if path.is_file()):
        parts = path.relative_to(root).parts
        if "__pycache__" not in parts and not any(part.startswith(".") for part in parts):
            yield path


def _imported_modules(top_paths: Iterable[Path], checks: Path) -> set[Path]:
    """Return the modules of other chapters' checks that these checks import, directly or indirectly."""
    pending, modules = (
        [path for top in top_paths for path in (top, *top.rglob("*")) if path.suffix == ".py"],
        set[Path](),
    )
    while pending:
        for name, names in CHECKS_IMPORT.findall(pending.pop().read_text(encoding="utf-8")):
            module_name = [name, *(f"{name}.{imported}" for imported in re.findall(r"\w+", names))]
            for path in (path for module in module_name for path in _modules(module, checks)):
                if path not in modules and not any(path == top or top in path.parents for top in top_paths):
                    modules.add(path)
                    pending.append(path)
    return modules


def _modules(module_name: str, checks: Path) -> Iterator[Path]:
    """Yield the files of a module of the checks and of the packages around it."""
    parts = module_name.strip(".").split(".")
    for count in range(1, len(parts) + 1):
        path = checks.joinpath(*parts[:count])
        yield from filter(Path.is_file, (path / "__init__.py", path.with_suffix(".py")))


def _is_read(parts: tuple[str, ...]) -> bool:
    """Return whether every grading reads a file of the autograder or the simulator."""
    if parts[:2] == ("autograder", "checks"):
        return len(parts) == 3  # the package itself; the chapters are in folders
    return parts[0] != "autograder" or not NOT_READ & {parts[1], "/".join(parts[1:3])}
