"""Patches files of the installed ROS wheels that do not work as shipped.

- CMake files refer to Python's and numpy's headers by folders of the build machine, `/opt/python/cp3XX-cp3XX/...`.
  Message packages do not compile until the files refer to this interpreter's headers.
- ament_flake8 lets flake8 fork. After tests that have used rclpy, whose threads a fork does not copy, the forked
  process may crash, and flake8 restarts it forever.
- rclpy 7.1's MultiThreadedExecutor polls the callback that it has given to a thread, and so blocks that thread. On an
  idle machine, a 10 Hz timer beside a 10 Hz subscription lost a quarter of its ticks and used half a core
  (github.com/ros2/rclpy/issues/1452).
- ament_lint_auto has no wheel, but every CMake package that `ros2 pkg create` creates requires it.

Each file is replaced atomically. Patching a file twice has no further effect.
"""

from __future__ import annotations

import os
import re
import sys
import sysconfig
from pathlib import Path

BUILD_MACHINE_PYTHONS = "/opt/python/"
_NUMPY = re.compile(r"/opt/python/cp\d+-cp\d+/lib/python3\.\d+/site-packages/numpy/_?core/include")
_HEADERS = re.compile(r"/opt/python/cp\d+-cp\d+/include/python3\.\d+")
_PREFIX = re.compile(r"/opt/python/cp\d+-cp\d+")

FLAKE8_INI = Path("ament_flake8/configuration/ament_flake8.ini")
ONE_PROCESS = "jobs = 1"

EXECUTORS = Path("rclpy/executors.py")
_SUBMIT = """\
            self._executor.submit(handler)
            self._futures.append(handler)
"""
_SUBMIT_AND_YIELD = """\
            self._executor.submit(handler)
            time.sleep(0.0001)  # mended: gives the interpreter to the thread that the handler waits for
            self._futures.append(handler)
"""

LINT_AUTO = Path("share/ament_lint_auto/cmake/ament_lint_autoConfig.cmake")
_NO_LINTERS = """\
# In place of ROS's own, which has no wheel: a CMake package that asks for its linters is built, and has none.
macro(ament_lint_auto_find_test_dependencies)
endmacro()
"""

STANDINS_PTH = "ros2_standins.pth"


def patched(text: str, *, headers: str, numpy_headers: str, prefix: str) -> str:
    """Return a CMake file's text with the build machine's folders replaced by this machine's."""
    text = _NUMPY.sub(lambda _: numpy_headers, text)
    text = _HEADERS.sub(lambda _: headers, text)
    return _PREFIX.sub(lambda _: prefix, text)


def unpatched_cmake_files(prefix: Path) -> list[Path]:
    """Return the CMake files under `prefix`/share that still contain folders of the build machine."""
    return [path for path in sorted((prefix / "share").rglob("*.cmake")) if BUILD_MACHINE_PYTHONS in path.read_text()]


def patch_wheels(prefix: Path) -> int:
    """Patch every CMake file under `prefix`; return how many changed."""
    files = unpatched_cmake_files(prefix)
    if not files:
        return 0
    import numpy

    for path in files:
        text = patched(
            path.read_text(),
            headers=sysconfig.get_paths()["include"],
            numpy_headers=numpy.get_include(),
            prefix=str(prefix),
        )
        _replace(path, text)
    return len(files)


def patch_flake8(site_packages: Path) -> bool:
    """Make ament_flake8 run flake8 in a single process; return whether the file was changed."""
    path = site_packages / FLAKE8_INI
    if not path.is_file() or ONE_PROCESS in path.read_text():
        return False
    _replace(path, path.read_text().rstrip("\n") + f"\n{ONE_PROCESS}\n")
    return True


def patch_executor(site_packages: Path) -> bool:
    """Make rclpy's MultiThreadedExecutor yield to its threads; return whether the file was changed."""
    path = site_packages / EXECUTORS
    if not path.is_file() or _SUBMIT not in path.read_text():
        return False
    _replace(path, path.read_text().replace(_SUBMIT, _SUBMIT_AND_YIELD))
    return True


def add_lint_auto(prefix: Path) -> bool:
    """Add an empty ament_lint_auto for CMake packages to the wheels' prefix; return whether it was missing."""
    path = prefix / LINT_AUTO
    if path.is_file() or not (prefix / "share/ament_cmake").is_dir():
        return False
    path.parent.mkdir(parents=True, exist_ok=True)
    _replace(path, _NO_LINTERS)
    return True


def link_standins(site_packages: Path) -> Path:
    """Put the stand-ins' folder at the end of `sys.path`, so that real packages are found first."""
    standins = Path(__file__).parent / "standins"
    pth = site_packages / STANDINS_PTH
    _replace(pth, f"{standins}\n")
    return pth


def _replace(path: Path, text: str) -> None:
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    temporary.write_text(text)
    temporary.replace(path)


if __name__ == "__main__":
    count = patch_wheels(Path(sys.prefix))
    packages = Path(sysconfig.get_paths()["purelib"])
    patch_flake8(packages)
    patch_executor(packages)
    add_lint_auto(Path(sys.prefix))
    link_standins(packages)
    print(f"patched {count} CMake files of the ROS wheels")
