"""The generators of a colcon build remember what was parsed, and write what rosidl's own would."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from autograder.grading.overlay import HOSTED, LEFT_OUT, write_overlay
from autograder.ros import activate

PACKAGE, FILE = "std_srvs", "srv/SetBool"
BELOW = ("builtin_interfaces", "service_msgs")
FAST, INTROSPECTION = "rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c"
OPTIONS = {
    "rosidl_generator_c": [],
    "rosidl_generator_py": ["--typesupport-impls", f"{FAST};{INTROSPECTION}"],
    "rosidl_typesupport_c": ["--typesupports", FAST, INTROSPECTION],
    FAST: [],
    INTROSPECTION: [],
}


def share(package: str) -> Path:
    return next(path for prefix in activate().prefixes if (path := prefix / "share" / package).is_dir())


def generate(generator: str, program: Path, out: Path) -> dict[str, str]:
    """Run a generator on one service; return what it wrote, by path."""
    for folder in ("srv/detail/dds_fastrtps", "srv"):
        (out / folder).mkdir(parents=True, exist_ok=True)
    below = [f"{name}:{idl}" for name in BELOW for idl in sorted(share(name).rglob("*.idl"))]
    values = {
        "package_name": PACKAGE,
        "output_dir": str(out),
        "template_dir": str(share(generator) / "resource"),
        "idl_tuples": [f"{share(PACKAGE)}:{FILE}.idl"],
        "type_description_tuples": [f"{FILE}.idl:{share(PACKAGE) / FILE}.json"],
        "ros_interface_files": [],
        "ros_interface_dependencies": below,
        "target_dependencies": [],
    }
    file = out.with_suffix(".json")
    file.write_text(json.dumps(values))
    command = [sys.executable, str(program), "--generator-arguments-file", str(file), *OPTIONS[generator]]
    environment = {**os.environ, "PYTHONHASHSEED": "0"}  # the order of some includes is that of a set
    done = subprocess.run(command, env=environment, text=True, capture_output=True)
    assert done.returncode == 0, done.stderr
    return {str(path.relative_to(out)): path.read_text() for path in out.rglob("*") if path.is_file()}


@pytest.fixture
def overlay(tmp_path: Path) -> Path:
    return write_overlay(activate().prefixes, tmp_path / "overlay")


def test_what_one_generator_has_parsed_the_others_recall_and_all_write_what_they_always_do(
    overlay: Path, tmp_path: Path
) -> None:
    kept: list[int] = []
    for generator in OPTIONS:
        ours = generate(generator, overlay / "lib" / generator, tmp_path / f"ours_{generator}")
        real = share(generator).parents[1] / "lib" / generator / generator
        assert ours
        assert ours == generate(generator, real, tmp_path / f"theirs_{generator}")
        (parsed,) = (overlay / "parsed").iterdir()
        kept.append(parsed.stat().st_ino)
    assert len(set(kept)) == 1  # nobody has written it anew


def test_every_generator_of_this_ros_has_its_config(overlay: Path) -> None:
    there = {name for name in (*HOSTED, *LEFT_OUT) if any((p / "share" / name).is_dir() for p in activate().prefixes)}
    assert there >= set(OPTIONS)
    assert {path.name for path in (overlay / "share").iterdir()} == there
    assert {path.name for path in (overlay / "lib").iterdir()} == there & set(HOSTED)


def test_where_ros_lacks_a_generator_there_is_nothing_in_its_place(tmp_path: Path) -> None:
    assert not list(write_overlay((tmp_path / "no_ros",), tmp_path / "overlay").glob("*/*"))
