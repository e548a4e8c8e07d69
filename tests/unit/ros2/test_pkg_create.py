"""`ros2 pkg create` refuses invalid requests, and prints what it creates."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.ros.ros2.main import run_stand_in as main


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Work in an empty folder, without the user's git settings."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    return tmp_path


def test_pkg_create_prints_each_file(capsys: pytest.CaptureFixture[str]) -> None:
    assert (
        main(["pkg", "create", "p", "--build-type", "ament_python", "--license", "MIT", "--maintainer-name", "A"])
        is None
    )
    printed = capsys.readouterr().out.splitlines()
    assert printed[0] == "going to create a new package"
    assert "maintainer: ['A <A@todo.todo>']" in printed
    assert printed[printed.index("creating folder ./p") :] == [
        "creating folder ./p",
        "creating ./p/package.xml",
        "creating source folder",
        "creating folder ./p/p",
        "creating ./p/setup.py",
        "creating ./p/setup.cfg",
        "creating folder ./p/resource",
        "creating ./p/resource/p",
        "creating ./p/p/__init__.py",
        "creating folder ./p/test",
        "creating ./p/test/test_copyright.py",
        "creating ./p/test/test_flake8.py",
        "creating ./p/test/test_pep257.py",
    ]
    assert Path("p/LICENSE").is_file()


def test_pkg_create_prints_the_folders_for_sources_and_headers(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pkg", "create", "p", "--license", "MIT"]) is None
    printed = capsys.readouterr().out.splitlines()
    assert printed[printed.index("creating folder ./p") :] == [
        "creating folder ./p",
        "creating ./p/package.xml",
        "creating source and include folder",
        "creating folder ./p/src",
        "creating folder ./p/include/p",
        "creating ./p/CMakeLists.txt",
    ]


def test_an_unknown_licence_is_allowed_with_a_warning(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pkg", "create", "p", "--license", "Mine"]) is None
    assert "[WARNING]: Unknown license 'Mine'." in capsys.readouterr().out
    assert not Path("p/LICENSE").exists()
    assert "<license>Mine</license>" in Path("p/package.xml").read_text()


def test_licences_can_be_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pkg", "create", "p", "--license", "?"]) is None
    assert "Apache-2.0" in capsys.readouterr().out.splitlines()
    assert not Path("p").exists()


def test_an_existing_folder_is_not_changed(capsys: pytest.CaptureFixture[str]) -> None:
    Path("p").mkdir()
    outcome = main(["pkg", "create", "p"])
    assert isinstance(outcome, str)
    assert capsys.readouterr().out == ""
    assert "The directory already exists: ./p" in outcome
    assert list(Path("p").iterdir()) == []


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("my-pkg",), "'my-pkg' cannot be the name of a package"),
        (("p", "--node-name", "2fast"), "'2fast' cannot be the name of a node"),
        (("p", "--library-name", "a b"), "'a b' cannot be the name of a library"),
        (("test", "--build-type", "ament_python"), "Aborted since"),
        (("p", "--build-type", "cmake"), "`ros2 pkg create --build-type cmake` is not covered"),
        (
            ("p", "--node-name", "n"),
            "`ros2 pkg create --build-type ament_cmake --node-name`, a C++ package, is not covered",
        ),
        (
            ("p", "--library-name", "l"),
            "`ros2 pkg create --build-type ament_cmake --library-name`, a C++ package, is not",
        ),
        (("p", "--destination-directory", "/proc/nowhere"), "unable to create /proc/nowhere/p"),
    ],
)
def test_an_invalid_call_of_pkg_create_is_rejected(words: tuple[str, ...], error: str) -> None:
    outcome = main(["pkg", "create", *words])
    assert isinstance(outcome, str)
    assert outcome.startswith(error)


def test_a_node_named_like_the_library_is_renamed(capsys: pytest.CaptureFixture[str]) -> None:
    assert (
        main(["pkg", "create", "p", "--build-type", "ament_python", "--node-name", "x", "--library-name", "x"]) is None
    )
    assert "[WARNING] renaming node to x_node" in capsys.readouterr().err
    assert Path("p/p/x_node.py").is_file()
