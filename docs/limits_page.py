"""The page `limits.md`, generated from the sandbox's limits."""

from __future__ import annotations

from autograder.author.course.markdown_table import table
from autograder.building.bundle_server import CACHE
from autograder.building.interfaces.cache import LIMIT
from autograder.diagnosis import MAX_DETAIL, MAX_SENTENCE
from autograder.grade.bounded_json import NOTEBOOK_VALUES, RESULT_VALUES, RUN_VALUES
from autograder.grade.executed_notebook import MAX_BYTES
from autograder.grade.reply import MAX_PAGE, MAX_RESULT
from autograder.harness.launch import MAX_STATUS
from autograder.plain_text import MAX_NAME, MAX_NAMES
from autograder.probes import imports, installed
from autograder.probes.student_test_reports import MAX_SOURCES
from autograder.run.fork_server import seccomp
from autograder.run.lockstep.protocol import MAX_LINE
from autograder.run.patience import MAX_ANSWER_SECONDS
from autograder.run.sandbox import limits
from autograder.run.sandbox.limits import MIB, TreeLimits
from autograder.submission.intake.bounds import MAX_MEMORY, MAX_SECONDS
from autograder.submission.intake.files import MAX_FILES, MAX_READ_BYTES, MAX_SCANNED, MAX_TOTAL_BYTES
from autograder.submission.intake.notebooks import MAX_CELLS, MAX_VALUES
from autograder.submission.intake.tar import MAX_EXTENDED, MAX_HEADER
from autograder.submission.intake.zip_directory import MAX_EXTRA

HEAD = """# Limits by kind

The resources that a submission may use, how each limit is enforced, and the file that tests it. `make docs` writes this
page from the values in the code, most of which are in `autograder/run/sandbox/limits.py`.
"""
FOOT = """
If an ordinary user grades, all worker sandboxes run as the same user of the machine. They share the kernel's limits per
user that the table does not list, such as pipe memory and epoll watches. Root gives each worker sandbox a separate
user.
"""
ARGUMENTS, SANDBOX, WALLS, INSTALLED = "test_bubblewrap", "test_sandbox", "test_walls", "test_installed"
ANSWER, WORKER_BOUNDS = "test_reply", "test_worker_sandbox_bounds"


def current() -> str:
    """Return the page as Markdown."""
    return "\n".join([HEAD, *table(("resource", "limit", "enforced by", "test"), list(rows())), FOOT.strip() + "\n"])


def rows() -> list[tuple[str, str, str, str]]:
    """Return the rows: the resource, its limit, how it is enforced, and the file that tests it."""
    node, build, worker = limits.NODE, limits.BUILD, limits.GRADING_WORKER
    forbidden_calls = ", ".join(
        name for name in seccomp.FORBIDDEN if name in ("memfd_create", "shmget", "msgget", "add_key")
    )
    return [
        (
            "wall time of a submission",
            f"{worker.wall_seconds:.0f} s for all attempts",
            "the process that starts the worker",
            "test_time_budget",
        ),
        ("waiting for its nodes' answers", f"{MAX_ANSWER_SECONDS:.0f} s in all", "the worker", "test_patience"),
        (
            "wall time of a build; of a node",
            f"{build.wall_seconds:.0f} s; {node.wall_seconds:.0f} s",
            "a watcher",
            SANDBOX,
        ),
        (
            "CPU time of a process",
            f"{node.cpu_seconds} s; {build.cpu_seconds} s in a build",
            "the kernel",
            ARGUMENTS,
        ),
        (
            "memory of a node; of a build",
            f"{_mib(node.memory)}; {_mib(build.memory)}",
            "a watcher, a control group",
            SANDBOX,
        ),
        ("memory of a worker sandbox", _mib(worker.memory), "a watcher, a control group", SANDBOX),
        ("threads of a program", f"{node.threads}", f"a watcher; the kernel at {node.tasks}", SANDBOX),
        ("descriptors of a process", f"{node.open_files}", "the kernel", SANDBOX),
        (
            "descriptors in flight",
            f"{node.open_files} and those of one more message",
            "the kernel, by the row above",
            SANDBOX,
        ),
        (
            "inotify instances; watches",
            f"{limits.INOTIFY_INSTANCES}; {limits.INOTIFY_WATCHES} for each worker sandbox",
            "its user namespace",
            SANDBOX,
        ),
        ("queued signals", f"{limits.SIGNALS}", "the kernel", ARGUMENTS),
        ("keys, queues, segments, files in memory", "none", f"a system call filter ({forbidden_calls}, …)", SANDBOX),
        ("size of a file; new files", f"{_mib(node.file_size)}; {node.files:,}", "the kernel; a watcher", SANDBOX),
        ("/tmp and /dev/shm of a program", _mib(node.scratch), "a file system in memory", SANDBOX),
        ("a worker sandbox's scratch folder", _mib(limits.WORKER_SCRATCH), "a file system in memory", ARGUMENTS),
        ("its folder for the result", _mib(limits.WORKER_OUT), "another file system in memory", WORKER_BOUNDS),
        ("printed output", f"{_mib(node.output)}; {_mib(build.output)} in a build", "a watcher", SANDBOX),
        (
            "a submission",
            f"{MAX_FILES} files, {_mib(MAX_TOTAL_BYTES)}, {_mib(MAX_READ_BYTES)} unpacked",
            "intake",
            "test_intake",
        ),
        (
            "an archive",
            f"{_mib(MAX_READ_BYTES)} on disk, unless it is a zip; {MAX_SCANNED:,} files, folders and parts; "
            f"{MAX_EXTENDED} headers of {_mib(MAX_HEADER)} for a file in a tar; "
            f"{MAX_EXTRA} bytes of extra fields in a zip",
            "intake",
            "test_archive_costs",
        ),
        (
            "reading a submission",
            f"{MAX_SECONDS:.0f} s of processor time, {_mib(MAX_MEMORY)}",
            "intake",
            "test_archive_costs",
        ),
        (
            "a submitted notebook",
            f"{MAX_CELLS:,} cells, {MAX_VALUES:,} commas and brackets",
            "intake",
            "test_costs",
        ),
        ("installed files of a build", _tree(limits.INSTALLED), "a check before they are copied", INSTALLED),
        ("types of installed files", "files, folders, inner links", "a check before they are copied", INSTALLED),
        ("stored message sources", _tree(limits.SOURCES), "the process that stores them", INSTALLED),
        (f"the cache `{CACHE}`", f"{_mib(LIMIT)}, and entries in use", "its eviction", "test_cache"),
        (
            "a message of a program in lockstep",
            f"{MAX_LINE // 1024} KiB, plus one read",
            "the worker",
            "test_stepper",
        ),
        (
            "messages from the topics of a run",
            f"{limits.RECEIVED_MESSAGES.messages:,}; {_mib(limits.RECEIVED_MESSAGES.size)}",
            "the worker, before it parses one",
            "test_inflow",
        ),
        ("the exit report of a launch", f"{MAX_STATUS} bytes", "the worker", "test_launch_status"),
        (
            "an installed path; all installed paths",
            f"{limits.INSTALLED.path} bytes; {_mib(limits.INSTALLED.paths)}",
            "a check before they are copied",
            "test_bundle_worker",
        ),
        ("a message of a worker", _mib(limits.MESSAGE), "the process that starts the worker", WALLS),
        ("files of a result", _tree(limits.RESULT_FILES), "the process that starts the worker", WALLS),
        (
            "`result.json`; its values, a run's; a notebook's",
            f"{_mib(MAX_RESULT)}; {RESULT_VALUES:,}, {RUN_VALUES:,}; {NOTEBOOK_VALUES:,}",
            "the process that starts the worker, before parsing",
            ANSWER,
        ),
        (
            "a sentence of feedback; quoted output",
            f"{MAX_SENTENCE:,}; {MAX_DETAIL:,} characters",
            "the worker",
            "test_result",
        ),
        (
            "names that are compared with a word",
            f"{MAX_NAMES} of {MAX_NAME} characters",
            "the worker",
            "test_plain_text",
        ),
        (
            "Python that is searched for its imports",
            f"{imports.MAX_BYTES // 1024} KiB in a file; {_mib(imports.MAX_ALL_BYTES)}, {imports.MAX_FILES} files in a "
            "package",
            "the check, which fails",
            "test_imports",
        ),
        ("installed metadata", f"{installed.MAX_BYTES // 1024} KiB in a file", "the check, which fails", INSTALLED),
        ("tests that are parsed for their names", _mib(MAX_SOURCES), "the worker", "test_student_test_reports"),
        ("an executed notebook", f"{_mib(MAX_BYTES)}, or it has no outputs", "the worker", ANSWER),
        ("pictures and runs on a page", _mib(MAX_PAGE), "the process that starts the worker", ANSWER),
    ]


def _mib(size: int) -> str:
    return f"{size // MIB:,} MiB"


def _tree(tree: TreeLimits) -> str:
    return f"{tree.names:,} names, {_mib(tree.size)}, including holes"
