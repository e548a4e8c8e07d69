"""Mends the ROS wheels after pip: their CMake files name folders of the machine that built them.

The wheels' exported targets carry `/opt/python/cp3XX-cp3XX/...` for Python's and numpy's headers, so no message
package compiles until they point at this interpreter. Each file is replaced atomically; mending twice changes nothing.
"""

from __future__ import annotations

import os
import re
import sys
import sysconfig
from pathlib import Path

BAKED = "/opt/python/"
_NUMPY = re.compile(r"/opt/python/cp\d+-cp\d+/lib/python3\.\d+/site-packages/numpy/_?core/include")
_HEADERS = re.compile(r"/opt/python/cp\d+-cp\d+/include/python3\.\d+")
_PREFIX = re.compile(r"/opt/python/cp\d+-cp\d+")

STANDINS_PTH = "ros2_standins.pth"


def mended(text: str, *, headers: str, numpy_headers: str, prefix: str) -> str:
    """Return a CMake file's text with the build machine's folders replaced by this machine's."""
    text = _NUMPY.sub(lambda _: numpy_headers, text)
    text = _HEADERS.sub(lambda _: headers, text)
    return _PREFIX.sub(lambda _: prefix, text)


def baked_files(prefix: Path) -> list[Path]:
    """Return the CMake files under `prefix`/share that still name the build machine."""
    return [path for path in sorted((prefix / "share").rglob("*.cmake")) if BAKED in path.read_text()]


def mend_wheels(prefix: Path) -> int:
    """Mend every CMake file under `prefix`; return how many changed."""
    files = baked_files(prefix)
    if not files:
        return 0
    import numpy

    for path in files:
        text = mended(
            path.read_text(),
            headers=sysconfig.get_paths()["include"],
            numpy_headers=numpy.get_include(),
            prefix=str(prefix),
        )
        fresh = path.with_name(path.name + ".mended")
        fresh.write_text(text)
        fresh.replace(path)
    return len(files)


def link_standins(site_packages: Path) -> Path:
    """Put the stand-ins' folder at the end of `sys.path`, where anything real is found before them."""
    standins = Path(__file__).parent / "standins"
    pth = site_packages / STANDINS_PTH
    fresh = pth.with_name(f".{pth.name}.{os.getpid()}")
    fresh.write_text(f"{standins}\n")
    fresh.replace(pth)
    return pth


if __name__ == "__main__":
    count = mend_wheels(Path(sys.prefix))
    link_standins(Path(sysconfig.get_paths()["purelib"]))
    print(f"mended {count} CMake files of the ROS wheels")
