"""The locks pin everything with hashes, agree with each other, and name no package index."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from autograder import bootstrap

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parents[3]
BASE, DEV, BENCH, CLUSTER, HUB = (f"requirements{part}.lock" for part in ("", "-dev", "-bench", "-cluster", "-hub"))
ENTRY = r"[a-z0-9-]+==[^\s;]+( ; [^\\]+?)?( +--hash=sha256:[0-9a-f]{64})+"


def entries(lock: str) -> list[str]:
    """Return a lock's entries, each joined to one line."""
    text = (ROOT / lock).read_text().replace("\\\n", "")
    return text.splitlines()


def pins(lock: str) -> set[str]:
    """Return each pin, `name==version`, without its environment marker."""
    return {entry.split()[0] for entry in entries(lock)}


def names(lock: str) -> set[str]:
    """Return the names that a lock pins."""
    return {pin.partition("==")[0] for pin in pins(lock)}


@pytest.mark.parametrize("lock", [BASE, DEV, BENCH, CLUSTER, HUB])
def test_a_lock_contains_only_exact_pins_with_hashes(lock: str) -> None:
    invalid = [entry for entry in entries(lock) if not re.fullmatch(ENTRY, entry)]
    assert invalid == []
    assert len(entries(lock)) > (10 if lock in (BENCH, CLUSTER, HUB) else 100)


@pytest.mark.parametrize("lock", [BASE, DEV, BENCH, CLUSTER, HUB])
def test_a_lock_names_no_address_and_no_index(lock: str) -> None:
    assert (
        re.findall(r"(?im)^.*(?:://|@ |--index|--extra-index|--find-links|^-[a-z]).*$", (ROOT / lock).read_text()) == []
    )


@pytest.mark.promise("`make setup` installs them from `requirements.lock`.")
def test_the_tests_run_with_the_pins_that_users_install() -> None:
    assert pins(BASE) <= pins(DEV)


@pytest.mark.parametrize("lock", [BENCH, CLUSTER, HUB])
def test_additional_locks_do_not_change_the_pins_of_the_tests(lock: str) -> None:
    assert {pin for pin in pins(lock) if pin.partition("==")[0] in names(DEV)} <= pins(DEV)
    assert not any(name.startswith("ros-") for name in names(lock))


@pytest.mark.parametrize("name", ["cluster", "hub"])
def test_an_extra_with_a_lock_of_its_own_has_the_packages_of_the_lock(name: str) -> None:
    data = tomllib.loads((ROOT / "pyproject.toml").read_text())
    assert data["dependency-groups"][name] == data["project"]["optional-dependencies"][name]


def test_the_lock_of_the_hubs_proxy_has_a_hash_for_each_package_and_no_address() -> None:
    folder = ROOT / "assets" / "hub"
    lock, manifest = (json.loads((folder / name).read_text()) for name in ("package-lock.json", "package.json"))
    root_package = lock["packages"].pop("")
    assert root_package["dependencies"] == manifest["dependencies"]
    assert len(lock["packages"]) > 10
    assert [name for name, package in lock["packages"].items() if "integrity" not in package] == []
    assert [name for name, package in lock["packages"].items() if "resolved" in package] == []


def test_every_dependency_of_the_project_is_pinned() -> None:
    data = tomllib.loads((ROOT / "pyproject.toml").read_text())
    project = data["project"]
    for lock, dependencies in (
        (BASE, project["dependencies"]),
        (DEV, [line for extra in project["optional-dependencies"].values() for line in extra]),
        (BENCH, data["dependency-groups"]["bench"]),
        (CLUSTER, data["dependency-groups"]["cluster"]),
        (HUB, data["dependency-groups"]["hub"]),
    ):
        missing = {canonicalize_name(Requirement(line).name) for line in dependencies} - names(lock)
        assert missing == set(), f"{lock} is older than pyproject.toml: run `make lock`"


def test_without_ros_the_lock_keeps_what_the_course_itself_needs() -> None:
    remaining = set(re.findall(r"(?m)^([a-z0-9-]+)==", bootstrap.without_ros((ROOT / BASE).read_text())))
    assert {"numpy", "jupyterlab", "nbgrader", "colcon-core", "empy", "lark", "catkin-pkg"} <= remaining
    assert remaining == {name for name in names(BASE) if not name.startswith("ros-")} != names(BASE)
