"""Builds message classes with plain values from the text of a student's interface definitions."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from autograder.building.interfaces.definition_reader import MAX_BYTES, MAX_FILES, read
from autograder.building.interfaces.definitions import KINDS, Definition, DefinitionError, require_uses
from autograder.building.interfaces.prefix import exists
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.submission.exercise_stubs import explain
from autograder.submission.packages import find_packages

if TYPE_CHECKING:  # the process of the generators also imports this package, but not ROS
    from autograder.run.workspace import Workspace

Texts = tuple[tuple[str, str], ...]
"""Sorted pairs of a definition's path in its package, such as `msg/RobotStatus.msg`, and the definition's text."""


def load_interfaces(workspace: Workspace, package: str) -> Any:
    """Return the classes of an interface package in a student's workspace: `.msg.Name`, `.srv.Name`, `.action.Name`.

    For the same texts, two calls return the same objects.

    Raises:
        StudentError: the package or its definitions are missing or wrong.
    """
    source = workspace.root / "src"
    packages, broken = find_packages(source)
    try:
        if package not in packages and broken:
            raise StudentError(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, next(iter(broken.values()))))
        texts: dict[str, Texts] = {}
        _gather(packages, package, (), texts, {}, workspace.ros.prefixes)
        return classes(tuple(texts.items()))
    except StudentError as error:
        raise StudentError(explain(error.diagnosis, source, package)) from None


@lru_cache(maxsize=8)
def classes(packages: tuple[tuple[str, Texts], ...]) -> Any:
    """Return the classes of the last of these packages. Each package uses only those before it."""
    from autograder.building.interfaces.known_types import KnownTypes
    from autograder.building.interfaces.messages import add_package

    known = KnownTypes()
    return [add_package(name, read(name, dict(texts)), known) for name, texts in packages][-1]


def _gather(
    packages: dict[str, Path],
    package: str,
    dependants: tuple[str, ...],
    texts: dict[str, Texts],
    elements: dict[tuple[str, str], int],
    ros: tuple[Path, ...],
) -> None:
    """Add a package's texts to `texts` and its messages' sizes to `elements`, after those of its dependencies."""
    folder = packages.get(package)
    if folder is None:
        sentence = f"The package {package} is missing: src contains {', '.join(sorted(packages)) or 'no package'}."
        raise StudentError(Diagnosis(Kind.MISSING_PACKAGE, sentence))
    if package in dependants:
        sentence = (
            f"The packages {' and '.join(sorted(dependants))} use each other's messages: let only one use the other."
        )
        raise StudentError(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, sentence))
    if package in texts:
        return
    try:
        if exists(ros, package, None):
            raise DefinitionError("package.xml", f"ROS has a package {package} of its own: give yours another name")
        own_texts = _texts(folder)
        definitions = read(package, own_texts)
        for name in sorted({name for definition in definitions for name, _, _ in definition.uses} & set(packages)):
            _gather(packages, name, (*dependants, package), texts, elements, ros)
        _require_uses(definitions, texts, ros)
        definitions = read(package, own_texts, elements)
    except DefinitionError as error:
        sentence = f"src/{folder.name}: {error}."
        raise StudentError(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, sentence)) from None
    texts[package] = tuple(sorted(own_texts.items()))
    elements.update({(package, Path(d.path).stem): d.elements for d in definitions if d.path[:3] == "msg"})


def _require_uses(definitions: tuple[Definition, ...], texts: dict[str, Texts], ros: tuple[Path, ...]) -> None:
    """Raise a DefinitionError unless all messages of other packages that the definitions contain exist."""

    def exists_anywhere(package: str, message: str | None) -> bool:
        if package in texts:
            return message is None or f"msg/{message}.msg" in dict(texts[package])
        return exists(ros, package, message)

    require_uses(definitions, exists_anywhere)


def _texts(folder: Path) -> dict[str, str]:
    texts: dict[str, str] = {}
    for kind in KINDS:
        for path in sorted((folder / kind).glob(f"*.{kind}")):
            name = f"{kind}/{path.name}"
            if path.is_symlink() or not path.is_file():
                raise DefinitionError(name, "it is not a plain file")
            if len(texts) >= MAX_FILES:
                raise DefinitionError(name, f"more than {MAX_FILES} definitions")
            with path.open("rb") as file:
                content = file.read(MAX_BYTES + 1)
            try:
                texts[name] = content.decode("utf-8")
            except UnicodeDecodeError:
                raise DefinitionError(name, "it is not UTF-8 text: save it as UTF-8") from None
    return texts
