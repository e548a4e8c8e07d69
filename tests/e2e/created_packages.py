"""Packages as `ros2 pkg create` writes them, and a student's additions.

`python -m tests.e2e.created_packages` prints the files that the tool writes. With the real ros2cli, its output is
the record.
"""

from __future__ import annotations

import ast
import subprocess
import sys
import tempfile
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import yaml

from autograder import course_paths

RECORD = Path(__file__).with_name("created_packages.yaml")
ROS2 = (sys.executable, "-m", "autograder.ros.ros2", "pkg", "create", "--license", "Apache-2.0")
MAINTAINER = ("--maintainer-name", "Robot Course", "--maintainer-email", "robot.course@example.com")
VERSION = "0.1.0"  # 08 requires it; the tool writes 0.0.0
PYTHON, CMAKE = "ament_python", "ament_cmake"


def create(folder: Path, package: str) -> Path:
    """Create a package in `folder` as the author of the reference package of this name would; return its folder."""
    folder.mkdir(parents=True, exist_ok=True)
    reference = ElementTree.parse(course_paths.SOLUTIONS / package / "package.xml")
    build_type = CMAKE if (course_paths.SOLUTIONS / package / "CMakeLists.txt").is_file() else PYTHON
    options = ["--build-type", build_type, "--description", reference.findtext("description") or ""]
    if dependencies := [element.text or "" for element in reference.iter("depend")]:
        options += ["--dependencies", *dependencies]
    subprocess.run([*ROS2, package, *MAINTAINER, *options], cwd=folder, check=True, capture_output=True)
    return folder / package


def fill_in(created: Path, target: Path, given_folders: Collection[str] = ()) -> None:
    """Put the tool's files into `target`, a copy of the reference package, and add the student's files.

    Modules, launch files, configuration and further tests stay the reference's. So do the `given_folders`, which
    students get with the chapter.
    """
    for file in sorted(created.rglob("*")):
        if file.is_file() and file.relative_to(created).parts[0] not in given_folders:
            copy = target / file.relative_to(created)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(file.read_bytes())
    reference = course_paths.SOLUTIONS / created.name
    _declare(target / "package.xml", reference / "package.xml")
    if (target / "setup.py").is_file():
        _install(target / "setup.py", (reference / "setup.py").read_text())
    else:
        _generate(target / "CMakeLists.txt", (reference / "CMakeLists.txt").read_text())


def lines_of(package: Path) -> set[str]:
    """Return the lines of all files of a package, each with its file, except lines with the version."""
    return {
        f"{file.relative_to(package)}: {line.rstrip(', ')}"
        for file in package.rglob("*")
        if file.is_file() and "__pycache__" not in file.parts
        for line in file.read_text().splitlines()
        if "version" not in line
    }


def _declare(manifest: Path, reference: Path) -> None:
    text = manifest.read_text().replace("0.0.0", VERSION)
    present = {(element.tag, element.text) for element in ElementTree.fromstring(text)}
    missing = [
        element for element in ElementTree.parse(reference).getroot() if (element.tag, element.text) not in present
    ]
    lines = [
        f"  <{element.tag}>{element.text}</{element.tag}>\n"
        for element in missing
        if "depend" in element.tag or "group" in element.tag
    ]
    manifest.write_text(text.replace("  <export>", f"{''.join(lines)}\n  <export>"))


def _install(setup: Path, reference: str) -> None:
    text = setup.read_text().replace("0.0.0", VERSION)
    programs = reference.partition("'console_scripts': [\n")[2].partition("        ]")[0]
    files = reference.partition("['package.xml']),\n")[2].partition("    ],")[0]
    text = text.replace("from setuptools", "from glob import glob\n\nfrom setuptools", 1)
    text = text.replace("'console_scripts': [\n", f"'console_scripts': [\n{programs}")
    setup.write_text(text.replace("['package.xml']),\n", f"['package.xml']),\n{files}"))


def _generate(cmake: Path, reference: str) -> None:
    needed = "\n".join(line for line in reference.splitlines() if line.startswith("find_package(rosidl"))
    messages = reference[reference.index("rosidl_generate_interfaces(") : reference.index("ament_package()")]
    text = cmake.read_text().replace(
        "find_package(ament_cmake REQUIRED)", f"find_package(ament_cmake REQUIRED)\n{needed}"
    )
    cmake.write_text(text.replace("ament_package()", f"{messages}ament_package()"))


def facts(folder: Path) -> dict[str, Any]:
    """Create a package of each kind in `folder` and return their contents without the prose."""
    contents = {}
    for kind, options in ((PYTHON, ("--node-name", "hello")), (CMAKE, ())):
        package = f"of_{kind}"
        command = [*ROS2, package, *MAINTAINER, "--build-type", kind, "--dependencies", "rclpy", "std_msgs", *options]
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
        contents[kind] = dict(_facts(folder / package))
    return contents


def _facts(package: Path) -> Iterable[tuple[str, Any]]:
    for file in sorted(package.rglob("*")):
        name = str(file.relative_to(package))
        if file.name == "package.xml":
            yield (
                name,
                [
                    f"{element.tag}: {(element.text or '').strip()} {element.attrib or ''}".strip()
                    for element in _all(file)
                ],
            )
        elif file.suffix == ".py":
            yield name, _python(file.read_text())
        elif file.suffix == ".cfg":
            yield name, file.read_text().splitlines()
        elif file.name == "CMakeLists.txt":
            yield name, [line.strip() for line in file.read_text().splitlines() if line.strip() and "#" not in line]
        elif file.is_file():
            yield name, bool(file.read_text())


def _all(manifest: Path) -> list[ElementTree.Element]:
    return list(ElementTree.parse(manifest).iter())


def _python(text: str) -> list[str]:
    """Return the imports, the calls' arguments by name, the functions and their pytest marks."""
    parts = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import | ast.ImportFrom):
            parts.append(ast.unparse(node))
        elif isinstance(node, ast.keyword) and node.arg != "reason":
            parts.append(f"{node.arg}={ast.unparse(node.value)}")
        elif isinstance(node, ast.FunctionDef):
            parts.append(f"def {node.name}")
        elif isinstance(node, ast.Attribute) and ast.unparse(node).startswith("pytest.mark."):
            parts.append(ast.unparse(node))
    return parts


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        yaml.safe_dump(facts(Path(scratch)), sys.stdout, sort_keys=False, width=120)
