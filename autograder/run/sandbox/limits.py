"""The resource limits of each kind of program. Every limit of time, memory and size on a process tree is here."""

from __future__ import annotations

from dataclasses import dataclass, replace

MIB = 1024 * 1024
GIB = 1024 * MIB


@dataclass(frozen=True)
class Limits:
    """Limits of a process tree, which is killed if it exceeds one."""

    wall_seconds: float = 120.0  # real time from start to end
    cpu_seconds: int = 120  # processor time of each process
    memory: int = 1 * GIB  # bytes resident in the whole tree
    address_space: int = 8 * GIB  # bytes of virtual memory of each process
    threads: int = 256  # threads in the whole tree
    file_size: int = 64 * MIB  # bytes of the largest file written
    files: int = 50_000  # new files on the file systems that it can write to
    # Descriptors of each process. A user of the machine can only have as many descriptors in transit as the sender may
    # have open, and most other processes may open 1,024.
    open_files: int = 512
    output: int = 1 * MIB  # bytes written to stdout and stderr together
    scratch: int = 64 * MIB  # bytes of the private /tmp
    # Consecutive measurements, a quarter of a second apart, with too much memory or threads until the tree is killed.
    excess_measurements: int = 1

    @property
    def tasks(self) -> int:
        """The kernel's task limit, well above `threads`, so that an excess of `threads` is diagnosed first."""
        return self.threads * 4


@dataclass(frozen=True)
class TreeLimits:
    """Limits of the files that leave a sandbox."""

    names: int = 5000  # files, folders and links
    size: int = 64 * MIB  # apparent bytes in all, including holes
    depth: int = 32  # nested folders
    path: int = 1024  # bytes of a path
    paths: int = 1 * MIB  # bytes of all paths


@dataclass(frozen=True)
class MessageLimits:
    """Limits of the messages that one harness takes from the topics of a student's programs."""

    messages: int = 100_000
    # Bytes on the wire, in all. A list of small messages takes up to 60 times as much when parsed, which a worker has.
    size: int = 64 * MIB


# The harness limits each wait for a node. The wall time is for a node for which nothing waits.
NODE = Limits(wall_seconds=600.0)
# The limit of a build is its processor time, which does not depend on the machine's load. The wall time is for a build
# that waits.
BUILD = Limits(wall_seconds=420.0, cpu_seconds=180, memory=2 * GIB, output=4 * MIB, scratch=256 * MIB)
# `colcon test` with a student's tests. Tests that do not end are run twice, and a grading has time for both runs.
COLCON_TEST = replace(BUILD, wall_seconds=150.0)
# The submitted notebook's kernel.
KERNEL = Limits(wall_seconds=180.0, cpu_seconds=180, memory=2 * GIB, output=4 * MIB, scratch=256 * MIB)
# A `ros2` command, such as `ros2 launch` with all that it starts.
LAUNCH = Limits(wall_seconds=180.0, cpu_seconds=60, memory=2 * GIB, threads=1024)
# One pytest run of a student's tests. Five at a time have to fit into a worker sandbox.
TEST_RUN = Limits(wall_seconds=60.0, cpu_seconds=40, memory=768 * MIB)
# Calls of a student's functions.
CALLS = Limits(wall_seconds=30.0, cpu_seconds=30)
# A whole worker sandbox: a trusted worker and all its descendants, for a grading or for a notebook's request.
# Its sandboxes have their own limits, which a fork bomb exceeds until it is detected. That must not end the worker, so
# the worker sandbox has room for six fork bombs at once, and time until they are killed.
GRADING_WORKER = Limits(wall_seconds=900.0, memory=6 * GIB, threads=8192, output=4 * MIB, excess_measurements=8)
NOTEBOOK_WORKER = replace(GRADING_WORKER, wall_seconds=300.0)
# A worker sandbox that only reads a submission.
READING_WORKER = Limits(wall_seconds=120.0, memory=2 * GIB, threads=64)
# A worker sandbox of the verification, which runs many jobs. Each job has the wall time of GRADING_WORKER.
VERIFICATION_WORKER = replace(GRADING_WORKER, wall_seconds=24 * 3600.0)
WORKER_SCRATCH = 512 * MIB  # bytes of a worker sandbox's file system
WORKER_OUT = 96 * MIB  # bytes of a grading's output folder, which no student's program can fill: room for RESULT_FILES
WORKER_TMP = 64 * MIB  # bytes of a worker sandbox's /tmp, which contains no files of students
INOTIFY_INSTANCES = 16  # of a whole worker sandbox; by default, a user of the machine has 128
INOTIFY_WATCHES = 4096  # of a whole worker sandbox
SIGNALS = 1024  # queued signals of each sandbox; the kernel also counts them for the machine's user
INSTALLED = TreeLimits()  # an install space after a build, which is copied for each grading
# An install space with its note, when it is sent from the builder to the cache and to the worker.
CACHED = TreeLimits(names=5002, size=65 * MIB, depth=33, path=1088, paths=2 * MIB)
SOURCES = TreeLimits(names=2000, size=16 * MIB)  # the interface packages of a submission
RESULT_FILES = TreeLimits(names=200, depth=1)  # the output files of a worker: the result, its notebook, the pictures
RECEIVED_MESSAGES = MessageLimits()
MESSAGE = 4 * MIB  # bytes of one message from a worker, except a list of files
