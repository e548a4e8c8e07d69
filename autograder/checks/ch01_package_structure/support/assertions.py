"""Assertions on the source files and the installed files of a package."""

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
    """Return a package's source folder, or the expected one if the package does not exist."""
    source = workspace.root / "src"
    return find_packages(source)[0].get(name, source / name)


def expect_built(builds: Mapping[str, Diagnosis], name: str) -> None:
    """Fail the check, with colcon's error, unless a package was built."""
    if builds[name] is not OK:
        raise StudentError(builds[name])


def expect_manifest(workspace: Workspace, name: str) -> manifest.Manifest:
    """Return a package's manifest; fail the check unless it declares a Python package of this name."""
    package_manifest = manifest.read(source_of(workspace, name))
    expect(
        package_manifest.format == 3,
        f'package.xml has format="{package_manifest.format}"; it should have format="3".',
    )
    expect(
        package_manifest.name == name,
        f"In package.xml, the package is called {package_manifest.name}; it should be called {name}.",
    )
    observation = (
        f"The build type in <export> is {package_manifest.build_type}"
        if package_manifest.build_type
        else "There is no build type in <export>, so colcon takes the package for a CMake package"
    )
    expect(
        package_manifest.build_type == contract.BUILD_TYPE,
        f"{observation}; a Python package needs {contract.BUILD_TYPE}.",
    )
    return package_manifest


def read_manifest(workspace: Workspace, name: str) -> manifest.Manifest:
    """Return a package's manifest, which ROS may reject; fail the check if it is not XML."""
    return manifest.read_leniently(source_of(workspace, name))


def expect_licence(workspace: Workspace, name: str) -> None:
    """Fail the check unless package.xml names the licence of the exercise and no other."""
    licences = read_manifest(workspace, name).licences
    expect(
        licences == (contract.LICENCE,),
        f"In package.xml, the licence is {', '.join(licences) or 'missing'}; it should be {contract.LICENCE}.",
    )


def expect_declared(
    needed_imports: Collection[imports.Import], declared_names: Collection[str], missing_in_release: int = 0
) -> None:
    """Fail the check unless all imports are declared; declaring some of them earns part of the points.

    Args:
        needed_imports: the imports.
        declared_names: the names in package.xml that count.
        missing_in_release: how many imports the released package does not declare; 0 if it declares none of them.
    """
    missing = imports.undeclared(needed_imports, declared_names)
    total = missing_in_release or len(needed_imports)
    fraction = max(0.0, 1.0 - len(missing) / total) if total else 0.0
    expect(not missing, f"package.xml does not declare every import: {imports.describe(missing)}.", fraction=fraction)


def expect_rosdep_key(declared_names: Collection[str], module: str) -> None:
    """Fail the check if package.xml names a module as pip does, even if it also names the rosdep key."""
    key = imports.KEYS[module]
    message = f"package.xml declares {module}, which is not a rosdep key: declare only {key}."
    expect(module not in declared_names, message, fraction=0.75)


def expect_executable(installation: installed.Installed, name: str) -> None:
    """Fail the check unless a program is installed where `ros2 run` looks for it."""
    if name in installation.executables:
        return
    folder = f"lib/{installation.package}"
    if name in installation.misplaced:
        raise CheckFailed(
            f"{name} was installed in bin/, but ros2 run looks in {folder}/: set this folder in setup.cfg."
        )
    programs = ", ".join((*installation.executables, *installation.misplaced))
    reason = f"the installed programs are {programs}" if programs else "no program was installed"
    raise CheckFailed(f"{folder}/ does not contain {name}: {reason}.")


def expect_modules(installation: installed.Installed, source: Path) -> None:
    """Fail the check unless each Python file of the module was installed; part of them earns part of the points."""
    name = installation.package
    sources = sorted(path.relative_to(source) for path in (source / name).rglob("*.py"))
    missing = [module for file in sources if (module := _module_name(file)) not in installation.modules]
    # Any setup.py installs the files that are directly in the module's folder.
    nested_count = sum(len(file.parts) > 2 for file in sources)
    fraction = max(0.0, 1.0 - len(missing) / nested_count) if nested_count else 0.0
    expect(not missing, f"The package was installed without {', '.join(missing[:3])}.", fraction=fraction)


def _module_name(file: Path) -> str:
    return file.with_suffix("").as_posix().replace("/", ".").removesuffix(".__init__")


def expect_shared(installation: installed.Installed, source: Path, name: str) -> None:
    """Fail the check unless a file was installed unchanged, under the same path below share."""
    data = installation.read(name)
    if data is None:
        same_name = [shared for shared in installation.shared if Path(shared).name == Path(name).name]
        similar = same_name[0] if same_name else nearest(name, installation.shared)
        suggestion = f" ({similar} was)" if similar else ""
        raise CheckFailed(
            f"share/{installation.package}/{name} was not installed{suggestion}: list it in data_files in setup.py."
        )
    expect(files.read_plain(source / name, MAX_BYTES) == data, f"The installed {name} differs from the one in src.")


def expect_empty(source: Path, names: Collection[str]) -> None:
    """Fail the check if one of these files contains text; other checks test whether they exist."""
    names_with_text = [name for name in names if files.read_limited(source / name, MAX_BYTES, name).strip()]
    message = f"There is text in {' and '.join(names_with_text)}: the marker and each __init__.py should be empty."
    expect(not names_with_text, message, fraction=0.5)


def expect_develop(source: Path, package: str) -> None:
    """Fail the check unless `colcon build --symlink-install` also installs the programs in lib/PACKAGE."""
    settings = configparser.ConfigParser(interpolation=None)
    with contextlib.suppress(configparser.Error, OSError, UnicodeDecodeError):
        settings.read(source / "setup.cfg", encoding="utf-8")
    script_dir = settings.get("develop", "script_dir", fallback=settings.get("develop", "script-dir", fallback=""))
    message = (
        f"colcon build --symlink-install would install programs in {script_dir or 'bin'}: see [develop] in setup.cfg."
    )
    expect(script_dir == f"$base/lib/{package}", message, fraction=0.5)
