"""A package needs certain files before colcon runs, and its build must not leave links that lead outside."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from autograder.building import build, colcon
from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.submission import packages

NAME = "my_robot_package"
FILES = {
    "package.xml": f"<package><name>{NAME}</name></package>",
    "setup.py": "",
    "setup.cfg": "",
    f"resource/{NAME}": "",
    f"{NAME}/__init__.py": "",
}


def _write_package(source: Path, *, without: str = "", **files: str) -> Path:
    for name, text in {**FILES, **files}.items():
        if name != without:
            (source / NAME / name).parent.mkdir(parents=True, exist_ok=True)
            (source / NAME / name).write_text(text)
    return source


def _fault(source: Path) -> tuple[Kind, str]:
    with pytest.raises(StudentError) as excinfo:
        build.require_packages(source, (NAME,))
    return excinfo.value.diagnosis.kind, excinfo.value.diagnosis.sentence


def test_a_whole_package_is_found_by_the_name_in_its_manifest(tmp_path: Path) -> None:
    build.require_packages(_write_package(tmp_path), (NAME,))
    assert packages.find_packages(tmp_path) == ({NAME: tmp_path / NAME}, {})


@pytest.mark.promise("The message lists the files that were found.")
def test_a_missing_package_is_named_with_the_existing_ones(tmp_path: Path) -> None:
    _write_package(tmp_path, **{"package.xml": "<package><name>my_robot</name></package>"})
    (tmp_path / NAME).rename(tmp_path / "other")
    kind, sentence = _fault(tmp_path)
    assert kind is Kind.MISSING_PACKAGE
    assert sentence == "The package my_robot_package is missing: src contains my_robot."


def test_a_folder_without_a_manifest_is_not_a_package(tmp_path: Path) -> None:
    kind, sentence = _fault(_write_package(tmp_path, without="package.xml"))
    assert kind is Kind.MISSING_PACKAGE
    assert "src/my_robot_package has no package.xml with <name>my_robot_package</name>" in sentence


@pytest.mark.promise('| A submission "holds no package" |')
def test_a_missing_src_and_an_empty_src_have_different_messages(tmp_path: Path) -> None:
    assert "There is no ws/src folder" in _fault(tmp_path / "src")[1]
    assert "src contains no package" in _fault(tmp_path)[1]


@pytest.mark.parametrize("part", ["setup.py", "setup.cfg", f"resource/{NAME}", f"{NAME}/__init__.py"])
def test_a_half_written_package_is_reported_with_the_missing_files(tmp_path: Path, part: str) -> None:
    kind, sentence = _fault(_write_package(tmp_path, without=part))
    assert kind is Kind.HALF_WRITTEN_PACKAGE
    assert f"src/my_robot_package has no {part}: the package is incomplete" in sentence


@pytest.mark.parametrize("part", ["setup.py", "setup.cfg", f"resource/{NAME}", f"{NAME}/__init__.py"])
def test_a_package_that_colcon_checks_may_lack_any_file_but_its_manifest(tmp_path: Path, part: str) -> None:
    build.require_packages(_write_package(tmp_path, without=part), (NAME,), complete=False)


def test_a_malformed_manifest_of_another_package_does_not_stop_the_build(tmp_path: Path) -> None:
    _write_package(tmp_path)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "package.xml").write_text("<package><name>")
    build.require_packages(tmp_path, (NAME,))
    with pytest.raises(StudentError, match=r"src/other/package\.xml is not well-formed XML"):
        build.require_packages(tmp_path, ("other",))


def test_a_cmake_package_needs_none_of_pythons_files(tmp_path: Path) -> None:
    _write_package(tmp_path, without="setup.py", **{"CMakeLists.txt": ""})
    assert build.require_packages(tmp_path, (NAME,))


@pytest.mark.parametrize("text", ["<package><name>", "", "not xml", "<package>&x;</package>"])
def test_a_malformed_manifest_is_named_with_its_line(tmp_path: Path, text: str) -> None:
    kind, sentence = _fault(_write_package(tmp_path, **{"package.xml": text}))
    assert kind is Kind.HALF_WRITTEN_PACKAGE
    assert "src/my_robot_package/package.xml is not well-formed XML" in sentence
    assert "line" in sentence


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_a_manifest_with_entities_is_refused_before_they_are_read(tmp_path: Path, encoding: str) -> None:
    text = "<!DOCTYPE a [<!ENTITY b 'c'>]><package>&b;</package>"
    (tmp_path / "p").mkdir()
    (tmp_path / "p/package.xml").write_text(text, encoding=encoding)
    with pytest.raises(StudentError, match="has a <!DOCTYPE>"):
        packages.read_package(tmp_path / "p/package.xml")


def test_a_huge_manifest_is_not_read(tmp_path: Path) -> None:
    kind, sentence = _fault(_write_package(tmp_path, **{"package.xml": " " * (packages.MAX_MANIFEST + 1)}))
    assert kind is Kind.HALF_WRITTEN_PACKAGE
    assert "is larger than 64 KiB" in sentence


def test_links_inside_the_install_space_are_allowed(tmp_path: Path) -> None:
    install = tmp_path / "install"
    (install / "pkg" / "lib").mkdir(parents=True)
    (install / "pkg/lib/libx.so.1").write_text("")
    (install / "pkg/lib/libx.so").symlink_to("libx.so.1")
    colcon.require_contained(install)
    assert (install / "pkg/lib/libx.so").exists()


@pytest.mark.parametrize("link", ["install", "install/pkg", "install/pkg/lib/pkg"])
@pytest.mark.parametrize("target", ["/", "../../../..", "loop"])
def test_links_out_of_the_install_space_are_refused(tmp_path: Path, link: str, target: str) -> None:
    (tmp_path / link).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / link).symlink_to((tmp_path / link).name if target == "loop" else target)
    with pytest.raises(StudentError, match="which leads out of the install space") as excinfo:
        colcon.require_contained(tmp_path / "install")
    assert excinfo.value.diagnosis.kind is Kind.BUILD_FAILED


def test_packages_are_found_where_colcon_finds_them(tmp_path: Path) -> None:
    def write(folder: str) -> None:
        name = folder.rpartition("/")[2]
        package_folder = tmp_path / "src" / folder
        package_folder.mkdir(parents=True)
        contact = '<maintainer email="ada@example.org">Ada</maintainer><license>MIT</license>'
        elements = f"<name>{name}</name><version>0.0.0</version><description>d</description>{contact}"
        (package_folder / "package.xml").write_text(f'<package format="3">{elements}</package>')

    for folder in (
        "plain",
        "outer",
        "a/b/deep",
        ".hidden/c",
        "outer/inner",
        *(f"with_{each}/d/e" for each in packages.IGNORED),
    ):
        write(folder)
    for marker in packages.IGNORED:
        (tmp_path / "src" / f"with_{marker}" / marker).touch()
    (tmp_path / "src/a/b/deep/not_COLCON_IGNORE").touch()
    found_packages, broken = packages.find_packages(tmp_path / "src")
    assert (set(found_packages), broken) == ({"plain", "outer", "deep"}, {})
    command = [sys.executable, str(colcon.RUNNER), "--log-base", str(tmp_path / "log"), "list", "--base-paths", "src"]
    listed = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    assert {tuple(line.split("\t")[:2]) for line in listed.splitlines()} == {
        (name, str(folder.relative_to(tmp_path))) for name, folder in found_packages.items()
    }


def test_two_packages_of_one_name_are_named_with_both_folders(tmp_path: Path) -> None:
    _write_package(tmp_path)
    _write_package(tmp_path / "copy")
    kind, sentence = _fault(tmp_path)
    assert kind is Kind.HALF_WRITTEN_PACKAGE
    assert f"src/copy/{NAME} and src/{NAME} are two packages with the name {NAME}" in sentence


def test_a_package_that_colcon_would_give_another_name_is_not_built(tmp_path: Path) -> None:
    _write_package(tmp_path, **{"colcon.pkg": '{"name": "other"}'})
    assert "src/my_robot_package/package.xml has a colcon.pkg beside it" in _fault(tmp_path)[1]


def test_a_pipe_or_a_link_is_not_a_manifest(tmp_path: Path) -> None:
    _write_package(tmp_path)
    for name in ("pipe", "link"):
        (tmp_path / name).mkdir()
    os.mkfifo(tmp_path / "pipe" / "package.xml")
    (tmp_path / "link" / "package.xml").symlink_to(tmp_path / NAME / "package.xml")
    assert packages.find_packages(tmp_path) == ({NAME: tmp_path / NAME}, {})
