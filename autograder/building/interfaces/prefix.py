"""Builds a prefix with an interface package of this project from its definitions, or takes it from the cache."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import sysconfig
from collections.abc import Mapping
from functools import lru_cache, partial
from pathlib import Path

from autograder.building.interfaces.cache import Cache
from autograder.building.interfaces.definition_reader import read
from autograder.building.interfaces.definitions import InterfaceError, packages_used, require_uses
from autograder.ros import RosEnvironment, activate
from autograder.ros.environment import without_wheel_bootstrap

HERE = Path(__file__).parent
BUILD_SECONDS = 120.0  # maximum real time of a build
RECIPE = "recipe.json"
BUILD_MODULES = (
    "building/interfaces/generate",
    "building/interfaces/compile",
    "submission/packages",
    "ros/environment",
)  # the modules that determine the content of a prefix


class GenerationError(InterfaceError):
    """The generators or the compiler rejected definitions that `read` accepts."""


def build(package: str, files: Mapping[str, str], *, cache: Cache | None = None) -> Path:
    """Build a package from its definitions, unless the cache contains it. Return the prefix with the package.

    The prefix exists at least until another one is built.

    Args:
        package: the package's name.
        files: the definitions' texts by their paths in the package: `msg/*.msg`, `srv/*.srv`, `action/*.action`.
        cache: the cache for the prefix, by default this user's.

    Raises:
        DefinitionError: a definition is wrong.
        GenerationError: the generators or the compiler failed.
        RosError: no usable ROS 2 was found.
    """
    ros = activate()
    definitions = read(package, files)
    require_uses(definitions, lambda name, message: exists(ros.prefixes, name, message))
    recipe = {
        "package": package,
        "texts": {definition.path: definition.text for definition in definitions},
        "uses": sorted(set(packages_used(definitions)) - {package}),
        "prefixes": [str(path) for path in ros.prefixes],
    }
    identity_text = json.dumps([recipe, identity(ros), _build_modules_digest()], sort_keys=True)
    key = hashlib.sha256(identity_text.encode()).hexdigest()[:40]
    return (cache or Cache.default("interfaces")).get(key, partial(_make, package, json.dumps(recipe)))


def exists(prefixes: tuple[Path, ...], package: str, message: str | None) -> bool:
    """Return whether one of the prefixes contains a message, or any message of the package if `message` is None."""
    folders = (prefix / "share" / package / "msg" for prefix in prefixes)
    return any((folder if message is None else folder / f"{message}.idl").exists() for folder in folders)


def identity(ros: RosEnvironment) -> dict[str, object]:
    """Return what a built package depends on besides its definitions: the interpreter, and the versions of ROS."""
    return {
        "prefixes": [str(prefix) for prefix in ros.prefixes],
        "python": [sys.executable, sys.version, sysconfig.get_config_var("EXT_SUFFIX")],
        "ros": _versions(ros),
    }


@lru_cache(maxsize=1)
def _versions(ros: RosEnvironment) -> list[str]:
    """Return the versions of ROS's wheels or, for a sourced ROS, the size and time of each package's manifest."""
    if ros.kind == "wheels":  # the folders' names are used, because reading their content takes half a second
        versions = [path.stem for path in ros.rclpy.parent.glob("*.dist-info")]
        return sorted(name for name in versions if name.lower().startswith(("ros-", "ros_", "numpy")))
    manifests = [path for prefix in ros.prefixes for path in sorted(prefix.glob("share/*/package.xml"))]
    return [f"{path} {path.stat().st_size} {path.stat().st_mtime_ns}" for path in manifests]


@lru_cache(maxsize=1)
def _build_modules_digest() -> str:
    return hashlib.sha256(b"".join((HERE.parents[1] / f"{name}.py").read_bytes() for name in BUILD_MODULES)).hexdigest()


def _make(package: str, recipe: str, prefix: Path) -> None:
    (prefix / RECIPE).write_text(recipe)
    path = [
        str(HERE.parents[2]),
        *filter(None, [os.environ.get("PYTHONPATH")]),
    ]  # so that the process imports the same modules
    try:
        completed = subprocess.run(
            [sys.executable, "-m", "autograder.building.interfaces.generate", str(prefix)],
            capture_output=True,
            stdin=subprocess.DEVNULL,
            text=True,
            errors="replace",
            timeout=BUILD_SECONDS,
            cwd="/",  # because `python -m` imports modules from the current folder
            env={**without_wheel_bootstrap(os.environ), "PYTHONPATH": os.pathsep.join(path)},
        )
    except subprocess.TimeoutExpired:
        raise GenerationError(f"{package}: building its interfaces took more than {BUILD_SECONDS:.0f} s") from None
    if completed.returncode != 0:
        last_lines = "\n".join(completed.stderr.strip().splitlines()[-12:])
        raise GenerationError(f"{package}: its interfaces cannot be built. {last_lines[:2000]}")
