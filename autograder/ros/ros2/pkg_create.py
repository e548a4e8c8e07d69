"""`ros2 pkg create`."""

from __future__ import annotations

import argparse
import getpass
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from datetime import date
from pathlib import Path

from autograder.ros.ros2 import pkg_templates as templates
from autograder.ros.ros2.exceptions import NotCoveredError, Ros2Error
from autograder.ros.ros2.parsing import ExitCode
from autograder.ros.ros2.pkg_templates import LICENCE_TEXTS, PackageSpec

MANIFEST, LICENCE = "package.xml", "LICENSE"
_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `ros2 pkg create`."""
    parser.add_argument("package_name", help="The package name")
    parser.add_argument(
        "--package-format",
        "--package_format",
        type=int,
        default=3,
        choices=[2, 3],
        help="The package.xml format",
    )
    parser.add_argument(
        "--description", default="TODO: Package description", help="The description given in the package.xml"
    )
    parser.add_argument(
        "--license",
        default="TODO: License declaration",
        help="The license attached to this package; this can be an arbitrary string, but a LICENSE file will only be "
        "generated if it is one of the supported licenses (pass '?' to get a list)",
    )
    parser.add_argument("--destination-directory", default=".", help="Directory where to create the package directory")
    parser.add_argument(
        "--build-type",
        default="ament_cmake",
        choices=["cmake", "ament_cmake", "ament_python"],
        help="The build type to process the package with",
    )
    parser.add_argument("--dependencies", nargs="+", default=[], help="list of dependencies")
    parser.add_argument("--maintainer-email", help="email address of the maintainer of this package")
    parser.add_argument("--maintainer-name", default=getpass.getuser(), help="name of the maintainer of this package")
    parser.add_argument("--node-name", help="name of the empty executable")
    parser.add_argument("--library-name", help="name of the empty library")


def run(args: argparse.Namespace) -> ExitCode:
    """Write a new package below the destination directory."""
    if args.license == "?":
        print("Supported licenses:", *LICENCE_TEXTS, sep="\n")
        return None
    spec = _read_spec(args)
    folder = Path(args.destination_directory) / spec.name
    if folder.exists():
        return (
            f"\nAborted!\nThe directory already exists: {_printable(folder)}\n"
            "Either remove the directory or choose a different destination directory or package name"
        )
    _describe(spec, Path(args.destination_directory))
    licence = templates.licence_text(spec.licence, spec.maintainer_name, date.today().year)
    created_folders: set[Path] = set()
    try:
        for relative, text in files(spec, licence):
            _write(folder, relative, text, created_folders)
            if relative == MANIFEST:
                print("creating source folder" if _is_python(spec) else "creating source and include folder")
    except OSError as error:
        return f"unable to create {folder}: {error}"
    if licence is None:
        print(
            f"\n[WARNING]: Unknown license '{spec.licence}'.  This has been set in the package.xml, but no LICENSE "
            "file has been created.\nIt is recommended to use one of the ament license identifiers:"
        )
        print(*LICENCE_TEXTS, sep="\n")
    return None


def files(spec: PackageSpec, licence: str | None) -> Iterator[tuple[str, str]]:
    """Yield the path and the text of each file of a package, in the real command's order.

    A path that ends with a slash is a folder.
    """
    yield MANIFEST, templates.package_xml(spec)
    yield from _python_files(spec) if _is_python(spec) else _cmake_files(spec)
    if licence is not None:
        yield LICENCE, licence


def _python_files(spec: PackageSpec) -> Iterator[tuple[str, str]]:
    yield f"{spec.name}/", ""
    yield "setup.py", templates.setup_py(spec)
    yield "setup.cfg", templates.setup_cfg(spec)
    yield f"resource/{spec.name}", ""
    yield f"{spec.name}/__init__.py", ""
    for name, text in templates.PYTHON_TESTS.items():
        yield f"test/{name}", text
    if spec.node_name:
        yield f"{spec.name}/{spec.node_name}.py", templates.python_node(spec)
    if spec.library_name:
        yield f"{spec.name}/{spec.library_name}/__init__.py", ""


def _cmake_files(spec: PackageSpec) -> Iterator[tuple[str, str]]:
    yield "src/", ""
    yield f"include/{spec.name}/", ""
    yield "CMakeLists.txt", templates.cmakelists(spec)


def _is_python(spec: PackageSpec) -> bool:
    return spec.build_type == "ament_python"


def _read_spec(args: argparse.Namespace) -> PackageSpec:
    """Validate the arguments. If they lack an e-mail address, take the one in git's configuration.

    Raises:
        Ros2Error: a name is not valid for a package, node or library.
        NotCoveredError: the build type is not covered, or a C++ executable or library was requested.
    """
    if args.build_type == "cmake":
        raise NotCoveredError("`ros2 pkg create --build-type cmake`")
    for noun, name in (("package", args.package_name), ("node", args.node_name), ("library", args.library_name)):
        if name is not None and not _IDENTIFIER.fullmatch(name):
            raise Ros2Error(
                f"'{name}' cannot be the name of a {noun}: take letters, digits and underscores, a letter first"
            )
    if args.build_type == "ament_cmake" and (args.node_name or args.library_name):
        option = "--node-name" if args.node_name else "--library-name"
        raise NotCoveredError(f"`ros2 pkg create --build-type ament_cmake {option}`, a C++ package,")
    node = args.node_name
    if args.build_type == "ament_python" and args.package_name == "test":
        raise Ros2Error(
            "Aborted since 'ament_python' packages can't be named 'test'. Please choose a different package name."
        )
    if node and node == args.library_name:
        node = f"{node}_node"
        print("[WARNING] node name can not be equal to the library name", file=sys.stderr)
        print(f"[WARNING] renaming node to {node}", file=sys.stderr)
    return PackageSpec(
        name=args.package_name,
        build_type=args.build_type,
        package_format=args.package_format,
        description=args.description,
        licence=args.license,
        maintainer_name=args.maintainer_name,
        maintainer_email=args.maintainer_email or _git_email() or f"{args.maintainer_name}@todo.todo",
        dependencies=tuple(args.dependencies),
        node_name=node,
        library_name=args.library_name,
    )


def _git_email() -> str:
    """Return the e-mail address in git's global configuration, or an empty string."""
    git = shutil.which("git")
    if git is None:
        return ""
    result = subprocess.run([git, "config", "--global", "user.email"], capture_output=True, text=True, check=False)
    return result.stdout.strip()


def _describe(spec: PackageSpec, destination: Path) -> None:
    print("going to create a new package")
    print("package name:", spec.name)
    print("destination directory:", destination.absolute())
    print("package format:", spec.package_format)
    print("version: 0.0.0")
    print("description:", spec.description)
    print("maintainer:", [f"{spec.maintainer_name} <{spec.maintainer_email}>"])
    print("licenses:", [spec.licence])
    print("build type:", spec.build_type)
    print("dependencies:", list(spec.dependencies))
    if spec.node_name:
        print("node_name:", spec.node_name)
    if spec.library_name:
        print("library_name:", spec.library_name)


def _write(folder: Path, relative: str, text: str, created_folders: set[Path]) -> None:
    """Write a file and its folder, and print both as the real command does."""
    path = folder / relative
    is_folder = relative.endswith("/")
    parent = path if is_folder else path.parent
    if parent not in created_folders:
        print(f"creating folder {_printable(parent)}")
        parent.mkdir(parents=True)
        created_folders.add(parent)
    if not is_folder:
        if relative != LICENCE:
            print(f"creating {_printable(path)}")
        path.write_text(text, encoding="utf-8")


def _printable(path: Path) -> str:
    """Return the path as the real command prints it: below the current directory, it begins with `./`."""
    return str(path) if path.is_absolute() or path.parts[:1] == ("..",) else f"./{path}"
