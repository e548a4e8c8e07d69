"""The resource limits of each kind of program: all limits of time, memory and size on a process tree."""

from __future__ import annotations

from dataclasses import dataclass, replace

MIB = 1024 * 1024
GIB = 1024 * MIB


@dataclass(frozen=True)
class Limits:
    """Limits of a process tree, which is killed if it exceeds one."""

    wall_seconds: float = 120.0  # real time from start to end
    cpu_seconds: int = 120  # processor time of each process
    memory: int = 1 * GIB  # resident bytes of the whole tree
    address_space: int = 8 * GIB  # bytes of virtual memory of each process
    threads: int = 256  # threads in the whole tree
    file_size: int = 64 * MIB  # bytes of each file that is written
    files: int = 50_000  # new files on the file systems that it can write to
    # Descriptors of each process. A user of the machine can have only as many descriptors in transit between processes
    # as the sender may have open, and most processes outside the sandbox may open 1,024.
    open_files: int = 512
    output: int = 1 * MIB  # bytes written to stdout and stderr together
    scratch: int = 64 * MIB  # bytes of the private /tmp
    # After how many consecutive measurements of too much memory or too many threads, a quarter of a second apart, the
    # tree is killed.
    excess_measurements: int = 1

    @property
    def tasks(self) -> int:
        """The kernel's limit on tasks. It is far above `threads`, so that too many threads are diagnosed first."""
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
    # Bytes on the wire, in all. Parsed lists of small messages take up to 60 times as much memory, which a worker has.
    size: int = 64 * MIB


# The harness limits each wait for a node. The wall time limits a node for which nothing waits.
NODE = Limits(wall_seconds=600.0)
# A build is limited by its processor time, which does not depend on the machine's load. The wall time limits a build
# that only waits.
BUILD = Limits(wall_seconds=420.0, cpu_seconds=180, memory=2 * GIB, output=4 * MIB, scratch=256 * MIB)
# `colcon test` with a student's tests. Tests that do not end are run twice, and a grading must have time for both runs.
COLCON_TEST = replace(BUILD, wall_seconds=150.0)
# The submitted notebook's kernel.
KERNEL = Limits(wall_seconds=180.0, cpu_seconds=180, memory=2 * GIB, output=4 * MIB, scratch=256 * MIB)
# A `ros2` command, such as `ros2 launch`, with everything that it starts.
LAUNCH = Limits(wall_seconds=180.0, cpu_seconds=60, memory=2 * GIB, threads=1024)
# One pytest run of a student's tests. Five at a time have to fit into a worker sandbox.
TEST_RUN = Limits(wall_seconds=60.0, cpu_seconds=40, memory=768 * MIB)
# Calls of a student's functions.
CALLS = Limits(wall_seconds=30.0, cpu_seconds=30)
# A whole worker sandbox: a trusted worker and all its descendants, for a grading or for a notebook's request.
# The sandboxes in it have their own limits, which a fork bomb exceeds until it is detected. That must not end the
# worker, so the worker sandbox has room for six fork bombs at once, and the time that it takes to kill them.
GRADING_WORKER = Limits(wall_seconds=900.0, memory=6 * GIB, threads=8192, output=4 * MIB, excess_measurements=8)
NOTEBOOK_WORKER = replace(GRADING_WORKER, wall_seconds=300.0)
# A worker sandbox in which a submission is only read. Intake's own limits of processor time and memory come first.
READING_WORKER = Limits(wall_seconds=300.0, memory=3 * GIB, threads=64)
# A worker sandbox of the verification, which runs many jobs. Each job has the wall time of GRADING_WORKER.
VERIFICATION_WORKER = replace(GRADING_WORKER, wall_seconds=24 * 3600.0)
WORKER_SCRATCH = 512 * MIB  # bytes of a worker sandbox's file system
WORKER_OUT = 96 * MIB  # bytes of a grading's output folder, enough for RESULT_FILES; students' programs cannot fill it
WORKER_TMP = 64 * MIB  # bytes of a worker sandbox's /tmp, which contains no files of students
INOTIFY_INSTANCES = 16  # of a whole worker sandbox; by default, a user of the machine can have 128
INOTIFY_WATCHES = 4096  # of a whole worker sandbox
SIGNALS = 1024  # queued signals of each sandbox; outside it, they also count for the machine's user
INSTALLED = TreeLimits()  # an install space after a build, which is copied for each grading
# An install space with its metadata, on the way from its builder to the cache and to the worker.
CACHED = TreeLimits(names=5002, size=65 * MIB, depth=33, path=1088, paths=2 * MIB)
SOURCES = TreeLimits(names=2000, size=16 * MIB)  # the interface packages of a submission
RESULT_FILES = TreeLimits(names=200, depth=1)  # the output files of a worker: the result, its notebook, the pictures
RECEIVED_MESSAGES = MessageLimits()
MESSAGE = 4 * MIB  # bytes of one message from a worker, except a list of files
