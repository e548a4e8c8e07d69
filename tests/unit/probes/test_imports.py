"""Imports of a package are read from its text and compared with its declared dependencies."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.course_paths import SOLUTIONS
from autograder.probes import imports, manifest
from autograder.suite import CheckFailed

FILES = {
    "lamp/__init__.py": "",
    "lamp/nodes/lamp_node.py": "import os, numpy.linalg\nfrom rclpy.node import Node\nfrom . import x\nimport lamp.x\n",
    "lamp/late.py": "def f():\n    try:\n        import yaml\n    except ImportError:\n        pass\n",
    "launch/lamp.launch.py": "from launch import LaunchDescription\nimport rclpy\n",
    "test/helper.py": "",
    "test/test_lamp.py": "import pytest\nimport helper\nimport numpy\nfrom lamp import late\n",
    "setup.py": "import setuptools\n",
    "build/lamp/stray.py": "import left_out\n",
}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package with imports of several kinds."""
    for name, text in FILES.items():
        path = tmp_path / "lamp" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path / "lamp"


def _names(found_imports: tuple[imports.Import, ...]) -> list[str]:
    return [found.module for found in found_imports]


def test_only_imports_from_outside_the_package_count(package: Path) -> None:
    assert _names(imports.imported(package)) == ["launch", "numpy", "pytest", "rclpy", "yaml"]


def test_a_folder_called_launch_is_not_the_module_launch(package: Path) -> None:
    assert _names(imports.imported(package, within=("launch",))) == ["launch", "rclpy"]
    assert _names(imports.imported(package, without=("launch", "test"))) == ["numpy", "rclpy", "yaml"]


def test_an_import_has_its_files_and_the_dependency_that_declares_it(package: Path) -> None:
    numpy = imports.imported(package)[1]
    assert numpy.files == ("lamp/nodes/lamp_node.py", "test/test_lamp.py")
    assert numpy.keys[0] == "python3-numpy"
    assert imports.Import("cv2", ()).keys[0] == "python3-opencv"
    assert imports.Import("sensor_msgs", ()).keys[0] == "sensor_msgs"
    assert imports.describe([numpy]) == "lamp/nodes/lamp_node.py imports numpy (python3-numpy)"
    assert imports.describe([imports.Import("launch", ("a.py",))]) == "a.py imports launch"


@pytest.mark.parametrize(
    ("module", "dependency"),
    [
        ("numpy", "python3-numpy"),
        ("tf2_ros", "tf2_ros"),
        ("lark_x", "python3-lark-x"),
        ("_pytest", "python3-pytest"),
        ("mpl_toolkits", "python3-matplotlib"),
    ],
)
def test_a_module_is_declared_by_its_rosdep_key_or_as_a_ros_package(module: str, dependency: str) -> None:
    assert not imports.undeclared([imports.Import(module, ())], {dependency})


def test_the_pip_name_of_a_module_is_not_a_rosdep_key(package: Path) -> None:
    found_imports = imports.undeclared(imports.imported(package), {"numpy", "rclpy", "launch", "python3-yaml"})
    assert _names(found_imports) == ["numpy", "pytest"]


def test_run_imports_need_a_run_dependency_and_test_imports_a_test_dependency(package: Path) -> None:
    text = """<package format="3"><name>lamp</name><version>0.1.0</version><description>x</description>
      <maintainer email="a@example.com">A</maintainer><license>MIT</license>
      <depend>rclpy</depend><build_depend>launch</build_depend><test_depend>python3-numpy</test_depend></package>"""
    found_imports = imports.missing(package, manifest.parse(text))
    assert _names(found_imports["exec"]) == ["launch", "numpy", "yaml"]
    assert _names(found_imports["test"]) == ["pytest"]


def test_the_reference_packages_declare_what_they_import() -> None:
    for name in ("square_dance", "wall_alarm"):
        folder = SOLUTIONS / name
        assert imports.missing(folder, manifest.read(folder)) == {"exec": (), "test": ()}


@pytest.mark.parametrize("text", ["import (", "\0", "-" * 100_000 + "1", "(" * 1000, "a" + ".b" * 50_000])
def test_a_text_that_cannot_be_parsed_is_refused_because_python_may_still_run_it(text: str) -> None:
    with pytest.raises(CheckFailed, match=r"lamp/x.py cannot be parsed as Python, so it cannot be searched"):
        imports.modules(text.encode(), "lamp/x.py")


def test_a_file_that_is_too_large_is_refused_by_its_name(package: Path) -> None:
    (package / "lamp" / "late.py").write_text("import numpy\n" + "\n" * imports.MAX_BYTES)
    with pytest.raises(CheckFailed, match=r"lamp/lamp/late.py is larger than 256 KiB"):
        imports.imported(package)
    assert _names(imports.imported(package, within=("launch",))) == ["launch", "rclpy"]


def test_a_link_is_ignored(tmp_path: Path) -> None:
    package = tmp_path / "lamp"
    package.mkdir()
    (tmp_path / "elsewhere.py").write_text("import scipy\n")
    (package / "linked.py").symlink_to(tmp_path / "elsewhere.py")
    assert imports.imported(package) == ()


def test_a_source_is_decoded_as_python_decodes_it(tmp_path: Path) -> None:
    (tmp_path / "hidden.py").write_bytes(b"# coding: utf-7\n# +AAo-import numpy\n")
    assert _names(imports.imported(tmp_path)) == ["numpy"]


def test_only_colcon_s_own_folders_are_skipped(package: Path) -> None:
    (package / "lamp" / "log").mkdir()
    (package / "lamp" / "log" / "__init__.py").write_text("import scipy\n")
    assert "scipy" in _names(imports.imported(package))


def test_the_bytes_of_all_files_are_bounded(tmp_path: Path) -> None:
    text = "#" * (imports.MAX_BYTES - 1) + "\n"
    count = imports.MAX_ALL_BYTES // imports.MAX_BYTES
    for number in range(count):
        (tmp_path / f"x{number}.py").write_text(text)
    assert imports.imported(tmp_path) == ()
    (tmp_path / "y.py").write_text("import numpy\n")
    with pytest.raises(CheckFailed, match="contains more than 4 MiB of Python"):
        imports.imported(tmp_path)


def test_the_number_of_files_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(imports, "MAX_FILES", 2)
    for name in "abc":
        (tmp_path / f"{name}.py").write_text(f"import outside_{name}\n")
    with pytest.raises(CheckFailed, match=r"contains more than 2 files .*too many to search"):
        imports.imported(tmp_path)
