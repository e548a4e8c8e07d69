"""The worker that builds interface packages for the cache. It receives their sources, but no submission.

python -m autograder.building.bundle_worker SCRATCH DESCRIPTOR
"""

from __future__ import annotations

import sys
from multiprocessing.connection import Connection
from pathlib import Path

from autograder.building.bundle_server import failure_message
from autograder.building.interface_bundle import build_alone
from autograder.exceptions import StudentError
from autograder.ros import activate
from autograder.run.sandbox.launcher import restore_sigint
from autograder.run.sandbox.limits import SOURCES
from autograder.run.sandbox.messages import receive_tree, send_message, send_tree, write_received
from autograder.run.workspace import Workspace
from autograder.submission.reading import reading


def main() -> None:
    """Build the packages that are received over the line, and send the installed files back."""
    scratch = Path(sys.argv[1])
    restore_sigint()
    ros = activate()
    with Connection(int(sys.argv[2])) as line:
        (scratch / "home").mkdir()
        workspace = Workspace(scratch / "ws", ros, scratch / "home")
        write_received(receive_tree(line, SOURCES), workspace.root / "src")
        try:
            with reading("The files that your interface packages install"):
                built = build_alone(workspace)
        except StudentError as error:
            send_message(line, failure_message(error))
        else:
            send_message(line, {})
            send_tree(line, built)


if __name__ == "__main__":
    main()
