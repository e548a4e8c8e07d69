"""Installed files are found as `ros2` finds them. No link is followed, and nothing is imported."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.probes import installed
from autograder.suite import CheckFailed

SITE = "lib/python3.12/site-packages"
EGG = f"{SITE}/lamp-0.1.0-py3.12.egg-info"
FILES = {
    "lib/lamp/lamp": "#!/usr/bin/python3\n",
    "bin/stray": "#!/usr/bin/python3\n",
    f"{SITE}/lamp/__init__.py": "raise SystemExit('imported')",
    f"{SITE}/lamp/nodes/__init__.py": "",
    f"{SITE}/lamp/nodes/lamp.py": "",
    f"{SITE}/test/__init__.py": "",
    f"{EGG}/entry_points.txt": "[console_scripts]\nlamp = lamp.nodes.lamp:main\n",
    f"{EGG}/requires.txt": "setuptools\n\n[test]\npytest\n\n[doc:python_version>'3']\nsphinx\n",
    f"{EGG}/PKG-INFO": "Metadata-Version: 2.1\nName: lamp\nVersion: 0.1.0\nLicense: MIT\n"
    "Classifier: A\nClassifier: B\n\nA lamp.\n",
    "share/ament_index/resource_index/packages/lamp": "",
    "share/lamp/package.xml": "<package/>",
    "share/lamp/package.bash": "",
    "share/lamp/hook/pythonpath.sh": "",
    "share/lamp/config/lamp.yaml": "a: 1\n",
}


@pytest.fixture
def install(tmp_path: Path) -> Path:
    """An install space with the package lamp in it."""
    for name, text in FILES.items():
        path = tmp_path / "install" / "lamp" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(0o755 if text.startswith("#!") else 0o644)
    log = tmp_path / "build" / "lamp" / "install.log"
    log.parent.mkdir(parents=True)
    log.write_text(f"{tmp_path}/install/lamp/share/lamp/package.xml\n{tmp_path}/install/torch/share/torch/x\n")
    return tmp_path / "install"


def test_all_installed_parts_of_a_package_are_listed(install: Path) -> None:
    contents = installed.inspect_package(install, "lamp")
    assert contents.executables == ("lamp",)
    assert contents.misplaced == ("stray",)
    assert contents.modules == {"lamp", "lamp.nodes", "lamp.nodes.lamp", "test"}
    assert contents.marker
    assert contents.shared == ("package.xml", "config/lamp.yaml")
    assert contents.recorded == {"share/lamp/package.xml"}
    assert contents.extras == {"test": ("pytest",), "doc": ("sphinx",)}
    assert contents.programs == {"lamp": "lamp.nodes.lamp"}
    assert contents.classifiers == ("A", "B")
    assert (contents.metadata["Version"], contents.metadata["License"]) == ("0.1.0", "MIT")
    assert contents.read("config/lamp.yaml") == b"a: 1\n"


def test_a_package_that_was_not_installed_has_nothing(tmp_path: Path) -> None:
    contents = installed.inspect_package(tmp_path / "install", "lamp")
    assert (contents.executables, contents.modules, contents.marker, contents.shared) == ((), frozenset(), False, ())
    assert contents.read("package.xml") is None


def test_a_record_behind_a_link_is_not_read(install: Path, tmp_path: Path) -> None:
    (tmp_path / "build" / "lamp").rename(tmp_path / "elsewhere")
    (tmp_path / "build" / "lamp").symlink_to(tmp_path / "elsewhere")
    assert installed.inspect_package(install, "lamp").recorded == frozenset()


def test_a_file_without_execute_permission_is_not_an_executable(install: Path) -> None:
    (install / "lamp/lib/lamp/lamp").chmod(0o644)
    assert installed.inspect_package(install, "lamp").executables == ()


def test_links_are_neither_listed_nor_read(install: Path, tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.mkdir()
    (secret / "key.yaml").write_text("secret")
    share = install / "lamp/share/lamp"
    (share / "config/link.yaml").symlink_to(secret / "key.yaml")
    (share / "folder").symlink_to(secret)
    (install / "lamp/lib/lamp/link").symlink_to("/bin/sh")
    contents = installed.inspect_package(install, "lamp")
    assert contents.shared == ("package.xml", "config/lamp.yaml")
    assert contents.executables == ("lamp",)
    assert contents.read("config/link.yaml") is None
    assert contents.read("folder/key.yaml") is None


def test_a_file_that_is_too_large_is_not_read(install: Path) -> None:
    (install / "lamp/share/lamp/config/lamp.yaml").write_bytes(b"#" * (installed.MAX_BYTES + 1))
    assert installed.inspect_package(install, "lamp").read("config/lamp.yaml") is None


@pytest.mark.parametrize("name", ["entry_points.txt", "PKG-INFO", "requires.txt"])
def test_metadata_that_are_too_large_are_refused(name: str, install: Path) -> None:
    with (install / "lamp" / EGG / name).open("a") as stream:
        stream.write("\n" * installed.MAX_BYTES)
    with pytest.raises(CheckFailed, match=f"{name} is larger than 256 KiB"):
        installed.inspect_package(install, "lamp")


def test_programs_that_cannot_be_read_are_refused(install: Path) -> None:
    (install / "lamp" / EGG / "entry_points.txt").write_text("stray = lamp.stray:main\n[console_scripts]\n")
    with pytest.raises(CheckFailed, match=r"The installed entry_points.txt cannot be parsed: File contains no section"):
        installed.inspect_package(install, "lamp")
