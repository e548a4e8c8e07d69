"""The scripts of `make image` choose a base and pass the machine's settings on. Other programs replace buildah here."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from autograder.course_paths import ROOT

pytestmark = pytest.mark.skipif(os.geteuid() != 0, reason="only root can build the image")
BUILDAH = """#!/bin/sh
echo "buildah $*" >>"$LOG"
case $1 in
inspect) grep -qxF "$4" "$STORE" ;;
pull) grep -qxF "$3" "$REGISTRY" || { echo 'no such host' >&2; exit 125; } ;;
from) echo working-container ;;
mount) mkdir -p "$MOUNT/etc/apt" && echo "$MOUNT" ;;
commit) echo "$4" >>"$STORE" ;;
esac
"""
DEBOOTSTRAP = """#!/bin/sh
echo "debootstrap $*" >>"$LOG"
echo 'deb http://mirror.example/debian bookworm main' >"$4/etc/apt/sources.list"
"""
DEFAULT = next(
    line.removeprefix("ARG BASE=")
    for line in (ROOT / ".binder" / "Dockerfile").read_text().splitlines()
    if line.startswith("ARG BASE=")
)
DEBIAN = "localhost/ros2-course-debian"


class Machine:
    """A machine whose buildah and debootstrap only record how they are called."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.log = folder, folder / "log"
        for name, script in (("buildah", BUILDAH), ("debootstrap", DEBOOTSTRAP)):
            (folder / name).write_text(script)
            (folder / name).chmod(0o755)
        for name in ("store", "registry", "log"):
            (folder / name).touch()

    def run(self, script: str, *arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
        """Run a script of assets/image with these environment variables."""
        places = {name.upper(): str(self.folder / name) for name in ("log", "store", "registry", "mount")}
        path = f"{self.folder}{os.pathsep}{os.defpath}"
        return subprocess.run(
            [ROOT / "assets" / "image" / script, *arguments],
            env={"PATH": path, **places, **variables},
            text=True,
            capture_output=True,
            check=False,
        )

    def calls(self) -> list[str]:
        """Return the calls of buildah and debootstrap, without those that only look for an image."""
        return [line for line in self.log.read_text().splitlines() if "inspect" not in line]


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    return Machine(tmp_path)


@pytest.mark.parametrize(("base", "expected"), [("", DEFAULT), ("ubuntu:24.04", "ubuntu:24.04")])
def test_the_base_comes_from_a_registry_if_one_has_it(machine: Machine, base: str, expected: str) -> None:
    (machine.folder / "registry").write_text(f"{expected}\n")
    process = machine.run("base", BASE=base)
    assert (process.returncode, process.stdout) == (0, f"{expected}\n"), process.stderr
    assert machine.calls() == [f"buildah pull --quiet {expected}"]


def test_an_image_that_the_machine_has_is_not_pulled(machine: Machine) -> None:
    (machine.folder / "store").write_text("mine\n")
    assert machine.run("base", BASE="mine").stdout == "mine\n"
    assert machine.calls() == []


def test_a_base_that_no_registry_has_is_an_error_that_names_it(machine: Machine) -> None:
    process = machine.run("base", BASE="unknown")
    assert (process.returncode, process.stdout) == (1, "")
    assert "no such host" in process.stderr
    assert process.stderr.endswith("image: there is no image unknown: choose another BASE\n")


@pytest.mark.promise("If no registry can be reached, debootstrap makes a base with Debian's Python.")
def test_without_a_registry_debootstrap_makes_the_base_once(machine: Machine) -> None:
    for _ in range(2):
        process = machine.run("base")
        assert (process.returncode, process.stdout) == (0, f"{DEBIAN}\n"), process.stderr
    made = [call for call in machine.calls() if call.startswith("debootstrap")]
    assert len(made) == 1
    assert "python3,python3-dev,python3-venv" in made[0]
    assert machine.calls().count("buildah rm working-container") == 1
    assert (machine.folder / "mount" / "etc" / "apt" / "sources.list").read_text().splitlines() == [
        "deb http://mirror.example/debian bookworm main",
        "deb http://mirror.example/debian-security bookworm-security main",
    ]


def test_the_image_is_built_from_a_release_with_the_settings_of_the_machine(machine: Machine) -> None:
    (machine.folder / "registry").write_text("ubuntu:24.04\n")
    arguments = ("/release", "course", "--build-arg", "JUPYTERHUB=4")
    process = machine.run("build", *arguments, BASE="ubuntu:24.04", PACKAGES="python3-dev python3-venv")
    assert process.returncode == 0, process.stderr
    call = machine.calls()[-1]
    assert call.startswith("buildah build --isolation chroot ")
    assert "--build-arg BASE=ubuntu:24.04 --build-arg PACKAGES=python3-dev python3-venv " in call
    assert call.endswith("--build-arg JUPYTERHUB=4 --tag course --file /release/.binder/Dockerfile /release")
    for path in ("/etc/pip.conf", "/etc/ssl/certs/ca-certificates.crt"):
        assert (f"--volume {path}:{path}:ro" in call) is Path(path).exists()


@pytest.mark.promise("`make image` needs root")
def test_another_user_is_told_to_use_sudo(machine: Machine) -> None:
    command = ["setpriv", "--reuid=65534", "--clear-groups", "bash", "-s"]
    script = (ROOT / "assets" / "image" / "base").read_text()
    process = subprocess.run(command, input=script, cwd="/", text=True, capture_output=True, check=False)
    assert process.returncode == 1
    assert process.stderr == "image: only root can build it: run this with sudo\n"
