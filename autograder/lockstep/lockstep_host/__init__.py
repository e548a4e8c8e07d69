"""The host: runs a student's unmodified program in the sandbox, and lets the grader step its time.

    python lockstep_host READ_FD WRITE_FD EXECUTABLE [ARGUMENTS...]

It runs in the student's own process and is trusted with nothing (see `protocol.py`). It imports nothing of the
grader: the sandbox shows it this one folder.
"""
