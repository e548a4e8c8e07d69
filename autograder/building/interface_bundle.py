"""Builds the interface packages of a submission as one bundle, which submissions with the same packages share.

Building messages takes ten times as long as building nodes, and most students of a class have the same messages. The
bundle is built in a separate workspace, so a cache entry depends only on the content that is its key. The output of
students' build files is used only in sandboxes. A worker has no cache: it requests bundles from `bundle_server`.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

from autograder.building import bundle_server
from autograder.building.colcon import colcon_build, read_installed, require_contained
from autograder.building.interfaces import Cache
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.run.sandbox import line
from autograder.run.sandbox.limits import MIB, SOURCES
from autograder.run.sandbox.messages import write_received
from autograder.run.sandbox.trees import Entry, TreeError, read_tree
from autograder.run.workspace import Workspace
from autograder.submission.packages import Package

GROUP = "rosidl_interface_packages"
METADATA = "bundle.json"
HOOKS = (".sh", ".bash", ".zsh", ".ps1", ".dsv", ".py")


def interface_bundle(packages: Mapping[str, Package], required: tuple[str, ...]) -> dict[str, Path]:
    """Return the folders of the interface packages among the required packages and their dependencies, by name.

    If one of them depends on another kind of package of the submission, the bundle is empty, and colcon builds
    everything together.
    """
    needed_names = _closure(packages, required)
    bundle = {name: packages[name].folder for name in needed_names if _is_interface(packages[name])}
    return bundle if _closure(packages, tuple(bundle)) == set(bundle) else {}


def install_bundle(bundle: dict[str, Path], workspace: Workspace) -> None:
    """Install a bundle's built packages in a workspace.

    The install space is checked first, because programs of the submission may have written to it in a failed build.
    """
    require_contained(workspace.install)
    tree = _sources(bundle)
    with workspace.private_folder() as folder:
        entry = folder / "bundle"
        with line.exclusive_line() as connection:
            if connection is None:
                make = partial(_make, tree, workspace, folder)
                with Cache.default(bundle_server.CACHE).use(bundle_server.key(tree), make) as built:
                    shutil.copytree(built, entry, symlinks=True)
            else:
                bundle_server.request_build(connection, tree, entry)
        metadata = json.loads((entry / METADATA).read_text())
        for name in bundle:
            if (workspace.install / name).is_dir():  # an earlier build of this grading has installed it
                continue
            shutil.copytree(entry / "install" / name, workspace.install / name, symlinks=True)
            relocate(workspace.install / name, metadata["install"], str(workspace.install))


def _sources(bundle: dict[str, Path]) -> dict[Entry, bytes]:
    """Read the sources of a bundle into a tree with a folder for each package."""
    tree: dict[Entry, bytes] = {}
    try:
        for name, folder in bundle.items():
            files = read_tree(folder, SOURCES)
            tree |= {Entry(name, "folder"): b""} | {_below(name, entry): data for entry, data in files.items()}
        if len(tree) > SOURCES.names or sum(map(len, tree.values())) > SOURCES.size:
            raise TreeError(f"more than {SOURCES.names} files and folders, or {SOURCES.size // MIB} MiB")
    except TreeError as error:
        sentence = f"The packages {', '.join(bundle)} hold {error}: message definitions are small."
        raise StudentError(Diagnosis(Kind.BUILD_FAILED, sentence)) from None
    return tree


def _below(folder: str, entry: Entry) -> Entry:
    return replace(entry, path=f"{folder}/{entry.path}")


def _make(tree: Mapping[Entry, bytes], workspace: Workspace, folder: Path, entry: Path) -> None:
    bundle_workspace = replace(workspace, root=folder / "alone")
    write_received(tree, bundle_workspace.root / "src")
    write_received(build_alone(bundle_workspace), entry)


def build_alone(workspace: Workspace) -> dict[Entry, bytes]:
    """Build all packages of a workspace that contains only a bundle's sources; return the installed files and metadata.

    Raises:
        StudentError: they do not build, install nothing, or install files that are not allowed.
    """
    folders = sorted((workspace.root / "src").iterdir())
    names = [folder.name for folder in folders]
    colcon_build(workspace, folders, "--packages-select", *names)
    installed_files = read_installed(workspace.install)
    for name in names:
        if Entry(name, "folder") not in installed_files:
            sentence = f"colcon built {name} but installed none of its files: check its package.xml and CMakeLists.txt."
            raise StudentError(Diagnosis(Kind.BUILD_FAILED, sentence))
    metadata = json.dumps({"install": str(workspace.install)}).encode()
    files = {
        _below("install", entry): data for entry, data in installed_files.items() if entry.path.split("/")[0] in names
    }
    return {Entry(METADATA, "file", size=len(metadata)): metadata, Entry("install", "folder"): b"", **files}


def relocate(prefix: Path, old: str, new: str) -> None:
    """Replace the old install path in the scripts that colcon wrote for a package. All other paths are relative."""
    for path in prefix.glob("share/*/*"):
        if path.suffix in HOOKS and path.is_file() and not path.is_symlink():
            text = path.read_bytes()
            if old.encode() in text:
                path.write_bytes(text.replace(old.encode(), new.encode()))


def _closure(packages: Mapping[str, Package], required: tuple[str, ...]) -> set[str]:
    """Return the required packages and all their dependencies in the submission."""
    names: set[str] = set()
    pending = [name for name in required if name in packages]
    while pending:
        name = pending.pop()
        if name not in names:
            names.add(name)
            pending += [other for other in packages[name].depends if other in packages]
    return names


def _is_interface(package: Package) -> bool:
    return GROUP in package.groups and (package.folder / "CMakeLists.txt").is_file()
