"""Runs a command with ROS 2 switched on: `python -m autograder.ros jupyter lab`.

Without a command it prints the variables as shell lines: `eval "$(python -m autograder.ros)"` is this project's
`source setup.bash`.
"""

from __future__ import annotations

import os
import shlex
import sys

from autograder.ros.environment import activate, find, path_with_scripts
from autograder.ros.exceptions import RosError


def main(arguments: list[str]) -> int:
    """Become the command in `arguments`, or print the variables; return the exit status when it cannot be."""
    try:
        if not arguments:
            for name, value in {**find().variables(), "PATH": path_with_scripts()}.items():
                print(f"export {name}={shlex.quote(value)}")
            return 0
        activate()
        os.execvp(arguments[0], arguments)
    except RosError as error:
        print(f"ROS 2: {error}.", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"{arguments[0]}: {error.strerror}", file=sys.stderr)
        return 127


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
