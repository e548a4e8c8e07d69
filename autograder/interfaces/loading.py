"""Making interface packages importable in this process: a built one, or one of a student's workspace from its texts."""

from __future__ import annotations

import importlib
import json
import os
import sys
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.exercise_stubs import explain
from autograder.interfaces.definitions import KINDS, MAX_BYTES, MAX_FILES, DefinitionError, InterfaceError, read
from autograder.interfaces.prefix import RECIPE, GenerationError, build
from autograder.packages import find_packages
from autograder.ros.environment import site_packages

if TYPE_CHECKING:  # the generators' process imports this package, too, and no ROS
    from autograder.workspace import Workspace

_loaded: dict[str, Path] = {}


def load(prefix: Path) -> ModuleType:
    """Import the package of a prefix that `build` returned, and those that it uses.

    Raises:
        InterfaceError: this process has another version of one of them.
    """
    recipe = json.loads((prefix / RECIPE).read_text())
    package = recipe["package"]
    if _loaded.get(package) == prefix:
        return sys.modules[package]
    if package in _loaded or package in sys.modules:
        there = _loaded.get(package) or sys.modules[package].__file__
        raise InterfaceError(
            f"{package} is loaded from {there} already: a process can hold one version of it, start another process"
        )
    for underlay in recipe["underlays"]:
        load(Path(underlay))
    sys.path.insert(0, str(site_packages(prefix)))
    found = os.environ.get("AMENT_PREFIX_PATH", "")
    os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join(filter(None, [str(prefix), found]))
    importlib.invalidate_caches()
    module = importlib.import_module(package)
    # The extension module brings the libraries with it; rcl then finds them, loaded, by their names.
    importlib.import_module(f"{package}.{package}_s__rosidl_typesupport_c")
    for kind in sorted({path.split("/")[0] for path in recipe["texts"]}):
        importlib.import_module(f"{package}.{kind}")
    _loaded[package] = prefix
    return module


def load_from(workspace: Workspace, package: str) -> ModuleType:
    """Build and load an interface package of a student's workspace, and those of it that it uses.

    Raises:
        StudentError: the package or its definitions are missing, or wrong; the sentence says where.
        InterfaceError: this process has another version of it.
    """
    source = workspace.root / "src"
    packages, broken = find_packages(source)
    try:
        if package not in packages and broken:
            raise StudentError(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, next(iter(broken.values()))))
        return load(_build(packages, package, ()))
    except StudentError as error:
        raise StudentError(explain(error.diagnosis, source, package)) from None


def _build(packages: dict[str, Path], package: str, above: tuple[str, ...]) -> Path:
    folder = packages.get(package)
    if folder is None:
        sentence = f"The package {package} is missing: src holds {', '.join(sorted(packages)) or 'no package at all'}."
        raise StudentError(Diagnosis(Kind.MISSING_PACKAGE, sentence))
    if package in above:
        sentence = f"The packages {' and '.join(sorted(above))} use each other's messages: let only one use the other."
        raise StudentError(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, sentence))
    try:
        texts = _texts(folder)
        used = {name for definition in read(package, texts) for name, _, _ in definition.uses}
        below = [_build(packages, name, (*above, package)) for name in sorted(used & set(packages))]
        return build(package, texts, underlays=tuple(below))
    except DefinitionError as error:
        sentence = f"src/{folder.name}: {error}."
        raise StudentError(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, sentence)) from None
    except GenerationError as error:
        sentence = f"The interfaces of {package} cannot be built from their definitions."
        raise StudentError(Diagnosis(Kind.BUILD_FAILED, sentence, str(error))) from None


def _texts(folder: Path) -> dict[str, str]:
    texts: dict[str, str] = {}
    for kind in KINDS:
        for path in sorted((folder / kind).glob(f"*.{kind}")):
            name = f"{kind}/{path.name}"
            if path.is_symlink() or not path.is_file():
                raise DefinitionError(name, "it is no plain file")
            if len(texts) >= MAX_FILES:
                raise DefinitionError(name, f"more than {MAX_FILES} definitions")
            with path.open("rb") as file:
                content = file.read(MAX_BYTES + 1)
            try:
                texts[name] = content.decode("utf-8")
            except UnicodeDecodeError:
                raise DefinitionError(name, "it is not UTF-8 text: save it as UTF-8") from None
    return texts
