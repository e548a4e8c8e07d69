"""Builds the prefix of one of our interface packages from its texts, or takes it from the cache."""

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
SECONDS = 120.0
RECIPE = "recipe.json"
OWN = (
    "building/interfaces/generate",
    "building/interfaces/compile",
    "submission/packages",
    "ros/environment",
)  # the modules that make a prefix


class GenerationError(InterfaceError):
    """The definitions read well, but the generators or the compiler would not have them."""


def build(package: str, files: Mapping[str, str], *, cache: Cache | None = None) -> Path:
    """Return a prefix with the package built from its definitions, from the cache if it was built before.

    The prefix stays until the cache is full and another one is built.

    Args:
        package: its name.
        files: texts by their path in the package: `msg/*.msg`, `srv/*.srv`, `action/*.action`.
        cache: where to keep it, this user's own cache by default.

    Raises:
        DefinitionError: a definition is wrong; names file and line.
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
    identity_text = json.dumps([recipe, identity(ros), _own_version()], sort_keys=True)
    key = hashlib.sha256(identity_text.encode()).hexdigest()[:40]
    return (cache or Cache.default("interfaces")).get(key, partial(_make, package, json.dumps(recipe)))


def exists(prefixes: tuple[Path, ...], package: str, message: str | None) -> bool:
    """Return whether a package with messages is in one of the prefixes, or a message of it."""
    folders = (prefix / "share" / package / "msg" for prefix in prefixes)
    return any((folder if message is None else folder / f"{message}.idl").exists() for folder in folders)


def identity(ros: RosEnvironment) -> dict[str, object]:
    """Return the dependencies of a built package besides its content: the Python, and the versions of ROS."""
    return {
        "prefixes": [str(prefix) for prefix in ros.prefixes],
        "python": [sys.executable, sys.version, sysconfig.get_config_var("EXT_SUFFIX")],
        "ros": _versions(ros),
    }


@lru_cache(maxsize=1)
def _versions(ros: RosEnvironment) -> list[str]:
    """Name the installed ROS: each wheel's version, or each sourced package's manifest by its size and time."""
    if ros.kind == "wheels":  # from the names of the folders: reading their content takes half a second
        versions = [path.stem for path in ros.rclpy.parent.glob("*.dist-info")]
        return sorted(name for name in versions if name.lower().startswith(("ros-", "ros_", "numpy")))
    manifests = [path for prefix in ros.prefixes for path in sorted(prefix.glob("share/*/package.xml"))]
    return [f"{path} {path.stat().st_size} {path.stat().st_mtime_ns}" for path in manifests]


@lru_cache(maxsize=1)
def _own_version() -> str:
    return hashlib.sha256(b"".join((HERE.parents[1] / f"{name}.py").read_bytes() for name in OWN)).hexdigest()


def _make(package: str, recipe: str, prefix: Path) -> None:
    (prefix / RECIPE).write_text(recipe)
    path = [str(HERE.parents[2]), *filter(None, [os.environ.get("PYTHONPATH")])]  # same module paths
    try:
        done = subprocess.run(
            [sys.executable, "-m", "autograder.building.interfaces.generate", str(prefix)],
            capture_output=True,
            stdin=subprocess.DEVNULL,
            text=True,
            errors="replace",
            timeout=SECONDS,
            cwd="/",  # `python -m` imports from the folder it is started in
            env={**without_wheel_bootstrap(os.environ), "PYTHONPATH": os.pathsep.join(path)},
        )
    except subprocess.TimeoutExpired:
        raise GenerationError(f"{package}: building its interfaces took more than {SECONDS:.0f} s") from None
    if done.returncode != 0:
        end = "\n".join(done.stderr.strip().splitlines()[-12:])
        raise GenerationError(f"{package}: its interfaces cannot be built. {end[:2000]}")
