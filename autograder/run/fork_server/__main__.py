"""A fork server: `python -m autograder.run.fork_server SOCKET_FD PROFILE ROOM`.

ROOM is for the programs' command lines.

In a forked process `main` returns a program's code and globals. No variable holds these: they end with the program.
"""

from autograder.run.fork_server.server import main

exec(*main())
