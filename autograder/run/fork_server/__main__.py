"""A fork server: `python -m autograder.run.fork_server SOCKET_FD PROFILE ROOM`.

ROOM is a placeholder of spaces, which the command lines of programs overwrite.

In a forked process, `main` returns a program's code and globals. No variable refers to them, so that they are released
when the program ends.
"""

from autograder.run.fork_server.server import main

exec(*main())
