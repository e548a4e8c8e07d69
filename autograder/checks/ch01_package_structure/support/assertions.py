"""Assertions on the files of one package and on what was installed of it."""

from __future__ import annotations

import configparser
import contextlib
from collections.abc import Collection, Mapping
from pathlib import Path

from autograder.checking import OK, CheckFailed, Diagnosis, StudentError, Workspace, expect, find_packages, nearest
from autograder.checking.probes import files, imports, installed, manifest
from autograder.checks.ch01_package_structure.support import contract

MAX_BYTES = 1024 * 1024  # of a file that is read


def source_of(workspace: Workspace, name: str) -> Path:
    """Return the folder of a package's sources, where it should be if it is nowhere."""
    source = workspace.root / "src"
    return find_packages(source)[0].get(name, source / name)


def expect_built(builds: Mapping[str, Diagnosis], name: str) -> None:
    """Fail the check, with what colcon said, unless a package was built."""
    if builds[name] is not OK:
        raise StudentError(builds[name])


def expect_manifest(workspace: Workspace, name: str) -> manifest.Manifest:
    """Return a package's manifest; fail the check unless ROS takes it for a Python package of this name."""
    found = manifest.read(source_of(workspace, name))
    expect(found.format == 3, f'package.xml says format="{found.format}"; the format of ROS 2 today is 3.')
    expect(found.name == name, f"package.xml names the package {found.name}, it should be {name}.")
    said = found.build_type or "none, and colcon takes it for CMake"
    expect(
        found.build_type == contract.BUILD_TYPE,
        f"The build type in <export> is {said}; a Python package's is {contract.BUILD_TYPE}.",
    )
    return found


def read_manifest(workspace: Workspace, name: str) -> manifest.Manifest:
    """Return what a package's manifest says; fail the check if it is no XML. Whether ROS takes it is another check."""
    return manifest.read_leniently(source_of(workspace, name))


def expect_licence(workspace: Workspace, name: str) -> None:
    """Fail the check unless package.xml names the one licence of the exercise."""
    licences = read_manifest(workspace, name).licences
    expect(licences == (contract.LICENCE,), f"The licence is {', '.join(licences)}, it should be {contract.LICENCE}.")


def expect_declared(needed: Collection[imports.Import], declared: Collection[str], first: int = 0) -> None:
    """Fail the check unless all imports are declared; part of the points for part of them.

    Args:
        needed: what is imported.
        declared: the names in package.xml that count.
        first: how many were missing when the exercise began; all of them if 0.
    """
    missing = imports.undeclared(needed, declared)
    total = first or len(needed)
    fraction = max(0.0, 1.0 - len(missing) / total) if total else 0.0
    expect(not missing, f"package.xml does not declare everything: {imports.describe(missing)}.", fraction=fraction)


def expect_executable(installation: installed.Installed, name: str) -> None:
    """Fail the check unless a program lies where `ros2 run` looks."""
    if name in installation.executables:
        return
    where = f"lib/{installation.package}"
    if name in installation.misplaced:
        raise CheckFailed(
            f"{name} was installed in bin/; ros2 run and launch files look in {where}/. That is setup.cfg's."
        )
    there = ", ".join((*installation.executables, *installation.misplaced))
    raise CheckFailed(
        f"{where}/ has no {name}: {f'what was installed is {there}' if there else 'no program was installed'}."
    )


def expect_modules(installation: installed.Installed, source: Path) -> None:
    """Fail the check unless each Python file of the module was installed; part of the points for part of them."""
    name = installation.package
    sources = sorted(path.relative_to(source) for path in (source / name).rglob("*.py"))
    missing = [module for file in sources if (module := _module(file)) not in installation.modules]
    deeper = sum(len(file.parts) > 2 for file in sources)  # what lies in the module itself is installed most easily
    fraction = max(0.0, 1.0 - len(missing) / deeper) if deeper else 0.0
    them = "it" if len(missing) == 1 else "them"
    expect(
        not missing,
        f"{', '.join(missing[:3])} stayed behind: the package was installed without {them}.",
        fraction=fraction,
    )


def _module(file: Path) -> str:
    return file.with_suffix("").as_posix().replace("/", ".").removesuffix(".__init__")


def expect_shared(installation: installed.Installed, source: Path, name: str) -> None:
    """Fail the check unless a file was installed under the same path in share, unchanged."""
    data = installation.read(name)
    if data is None:
        there = [shared for shared in installation.shared if Path(shared).name == Path(name).name]
        near = there[0] if there else nearest(name, installation.shared)
        seen = f" ({near} is)" if near else ""
        raise CheckFailed(
            f"share/{installation.package}/{name} was not installed{seen}: data_files in setup.py says what is."
        )
    expect(files.read_plain(source / name, MAX_BYTES) == data, f"The installed {name} is not the one in src.")


def expect_empty(source: Path, names: Collection[str]) -> None:
    """Fail the check if one of these files holds text; a file that is not there is for other checks."""
    full = [name for name in names if (files.read_plain(source / name, MAX_BYTES) or b"").strip()]
    said = f"There is text in {' and '.join(full)}: the marker and each __init__.py should be empty."
    expect(not full, said, fraction=0.5)


def expect_develop(source: Path, package: str) -> None:
    """Fail the check unless `colcon build --symlink-install` would put the programs into lib/PACKAGE, too."""
    settings = configparser.ConfigParser(interpolation=None)
    with contextlib.suppress(configparser.Error, OSError, UnicodeDecodeError):
        settings.read(source / "setup.cfg", encoding="utf-8")
    found = settings.get("develop", "script_dir", fallback=settings.get("develop", "script-dir", fallback=""))
    told = f"With colcon build --symlink-install, programs would go to {found or 'bin'}: see [develop] in setup.cfg."
    expect(found == f"$base/lib/{package}", told, fraction=0.5)
