"""The host: runs a student's unmodified program in the sandbox, and lets the grader step its time.

    python lockstep_host READ_FD WRITE_FD START_NS CLOCK_RATE EXECUTABLE [ARGUMENTS...]

It runs in the student's own process, so the grader trusts nothing that it says (see `protocol.py`). It imports nothing
of the grader: this folder is all of the grader's code that the sandbox shows.
"""
