"""The host: runs a student's unmodified program in the sandbox, and lets the grader step its time.

    python lockstep_host READ_FD WRITE_FD START_NS CLOCK_RATE EXECUTABLE [ARGUMENTS...]

It runs in the student's own process, so the grader does not trust its messages (see `protocol.py`). It imports no
modules from other folders of the grader, because only this folder is visible in the sandbox.
"""
