"""Arrange the ROS 2 of this virtual environment like an installation from packages, such as /opt/ros/jazzy.

`python -m tests.e2e.sourced_prefix FOLDER` copies the wheels, the real launch and ros2cli (`make real-launch`), and the
packages that colcon has built into the environment. A shell that sources FOLDER/setup.bash then has ROS 2 Jazzy as
installed from packages, without the wheels' start-up hook.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from importlib.metadata import Distribution, distributions
from pathlib import Path

PREFIX = Path(sys.prefix)
SITE = Path(sysconfig.get_path("purelib"))
REAL = ("ament_copyright", "launch", "ros2", "rosidl_runtime_py")
FROM_APT = ("argcomplete", "lark", "numpy", "osrf-pycommon", "packaging", "psutil", "pyyaml")
OURS = ("ros2_python_course", "ros2_course_standins")
SETUP = """# Source this file as you would source setup.bash of an installed ROS 2: it sets the same variables.
export ROS_VERSION=2 ROS_PYTHON_VERSION=3 ROS_DISTRO=jazzy
export AMENT_PREFIX_PATH="{prefix}${{AMENT_PREFIX_PATH:+:$AMENT_PREFIX_PATH}}"
export CMAKE_PREFIX_PATH="{prefix}${{CMAKE_PREFIX_PATH:+:$CMAKE_PREFIX_PATH}}"
export LD_LIBRARY_PATH="{libraries}${{LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}}"
export PYTHONPATH="{prefix}/{site}${{PYTHONPATH:+:$PYTHONPATH}}"
export PATH="{prefix}/bin:$PATH"
"""


def is_ros(distribution: Distribution) -> bool:
    """Return whether a distribution is part of ROS, and not one that ROS needs from the package index."""
    name = distribution.name.lower().replace("-", "_")
    return name.startswith(("ros_", *REAL)) and name not in OURS and not name.startswith("ros_wheels")


def files() -> Iterator[Path]:
    """Yield all files of ROS: those of its distributions, and those that colcon has installed."""
    for distribution in distributions():
        if is_ros(distribution):
            yield from (
                Path(os.path.normpath(str(distribution.locate_file(file)))) for file in distribution.files or ()
            )
    packages = {path.name for path in (PREFIX / "share/ament_index/resource_index/packages").iterdir()}
    folders = [PREFIX / "share/ament_index", PREFIX / "include"]
    folders += [root / package for package in packages for root in (PREFIX / "share", PREFIX / "lib", SITE)]
    folders += SITE.glob("ros_*.libs")
    yield from (PREFIX / "lib").glob("*.so*")
    for folder in folders:
        yield from folder.rglob("*")


def copy_prefix(target: Path) -> None:
    """Copy the files of ROS to `target`, with an interpreter for its programs.

    The interpreter is that of a virtual environment in `target`, with the packages that ROS needs from the package
    index. It takes the place of the system's Python, for which apt installs these packages.

    Raises:
        FileExistsError: `target` exists.
        subprocess.CalledProcessError: the environment cannot be made.
    """
    target.mkdir(parents=True)
    system = target / "python"
    subprocess.run([Path(sys.executable).resolve(), "-m", "venv", system], check=True)
    pinned = [
        f"{distribution.name}=={distribution.version}"
        for distribution in distributions()
        if distribution.name.lower() in FROM_APT
    ]
    subprocess.run([system / "bin/python", "-m", "pip", "install", "-qq", *pinned], check=True)
    interpreter = f"#!{system}/bin/python\n".encode()
    for file in sorted(set(files())):
        if not file.is_file() or not file.is_relative_to(PREFIX) or file.suffix == ".pyc":
            continue
        copy = target / file.relative_to(PREFIX)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(file, copy)
        head, _, rest = copy.read_bytes().partition(b"\n")
        if head.startswith(f"#!{PREFIX}".encode()):
            copy.write_bytes(interpreter + rest)
        elif copy.suffix == ".cmake":  # these files name the folder of numpy's headers
            copy.write_bytes(copy.read_bytes().replace(bytes(PREFIX), bytes(system)))
    site = SITE.relative_to(PREFIX)
    libraries = ":".join(map(str, [target / "lib", *(target / site).glob("ros_*.libs")]))
    (target / "setup.bash").write_text(SETUP.format(prefix=target, site=site, libraries=libraries))


def main() -> int:
    """Create the prefix and print the command that sources it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="the new folder; it must not exist")
    target = parser.parse_args().folder.absolute()
    copy_prefix(target)
    print(f"source {target}/setup.bash")
    return 0


if __name__ == "__main__":
    sys.exit(main())
