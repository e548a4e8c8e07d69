"""Installs packages that pip cannot install. It uses apt, unless sudo would ask for a password.

Run as `python3 -I autograder/doctor/apt.py`.

`autograder/bootstrap.py` runs this script in the system's Python, where only the standard library can be imported.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Callable, Sequence
from pathlib import Path

# The apt packages, and the commands of each. If one of the commands exists, the package counts as installed.
TOOLS = {
    "g++": ("g++",),
    "bubblewrap": ("bwrap",),
    "chromium": ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable"),
}


def missing_packages(headers: Path, *, browser: bool) -> list[str]:
    """Return the missing packages: tools, and Python's headers if they are not in the folder `headers`."""
    tools = [tool for tool in TOOLS if browser or tool != "chromium"]
    missing = [tool for tool in tools if not any(map(shutil.which, TOOLS[tool]))]
    return missing if (headers / "Python.h").is_file() else [*missing, f"python{sysconfig.get_python_version()}-dev"]


def install(missing: Sequence[str], attempts_file: Path, uid: int, run: Callable[..., int]) -> None:
    """Install packages, or print the command that installs them.

    Args:
        missing: the packages.
        attempts_file: the file that records the packages of earlier attempts, which are not tried again.
        uid: the user's id; users other than root need sudo.
        run: a function that runs a command silently and returns its exit status.
    """
    manual_command = f"sudo apt-get install {' '.join(missing)}"
    attempted_packages = attempts_file.read_text().split() if attempts_file.exists() else []
    sudo = [] if uid == 0 else ["sudo", "-n"]  # `env` turns a missing sudo into an exit status
    can_install = shutil.which("apt-get") and run("env", *sudo, "true") == 0
    if not can_install or set(missing) <= set(attempted_packages):
        print(f"set-up: {', '.join(missing)} is missing; to install it: {manual_command}", flush=True)
        return
    print(f"set-up: installing {', '.join(missing)} with apt-get", flush=True)
    apt = [*sudo, "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-o", "DPkg::Lock::Timeout=60"]
    run(*apt, "update")
    status = run(*apt, "install", "-y", "--no-install-recommends", *missing)
    attempts_file.parent.mkdir(exist_ok=True)
    attempts_file.write_text(" ".join({*attempted_packages, *missing}))
    if status != 0:
        print(f"set-up: apt-get failed; set-up continues; to install them yourself: {manual_command}", flush=True)


def require_compiler(missing: Sequence[str]) -> None:
    """If a package that is needed to compile messages is missing, exit with a message."""
    if needed_packages := [package for package in missing if package == "g++" or package.endswith("-dev")]:
        missing_files = " and ".join("g++" if package == "g++" else "Python.h" for package in needed_packages)
        sys.exit(
            f"set-up: {missing_files} not found, which ROS needs to compile messages: "
            f"run `sudo apt-get install {' '.join(needed_packages)}`, then the same command again."
        )


def main() -> None:
    """Install the missing packages."""
    parser = argparse.ArgumentParser(description="Install what pip cannot with apt, if that needs no password.")
    parser.add_argument("--browser", action="store_true", help="also install Chromium if there is no browser")
    parser.add_argument("--require-compiler", action="store_true", help="fail if messages cannot be compiled")
    options = parser.parse_args()
    headers, attempts_file = (
        Path(sysconfig.get_path("include")),
        Path(__file__).resolve().parents[2] / ".build" / "apt-tried",
    )

    def run(*command: str) -> int:
        quiet = subprocess.DEVNULL
        return subprocess.call(command, cwd="/", stdin=quiet, stdout=quiet, stderr=quiet)

    if missing := missing_packages(headers, browser=options.browser):
        install(missing, attempts_file, os.geteuid(), run)
    if options.require_compiler:
        require_compiler(missing_packages(headers, browser=False))


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)  # `bootstrap.py`, which is interrupted too, prints the message
