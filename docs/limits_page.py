"""The page `limits.md`, from the limits that the sandbox keeps."""

from __future__ import annotations

from autograder.author.course.markdown_table import table
from autograder.building.interfaces.cache import LIMIT
from autograder.building.keeper import CACHE
from autograder.grade.answer import MAX_RESULT, MAX_SHOWN
from autograder.grade.bounded_json import NOTEBOOK_VALUES, RESULT_VALUES, RUN_VALUES
from autograder.grade.executed_notebook import MAX_BYTES
from autograder.harness.launch import MAX_STATUS
from autograder.run.fork_server import seccomp
from autograder.run.lockstep.protocol import MAX_LINE
from autograder.run.patience import HELD_SECONDS
from autograder.run.sandbox import limits
from autograder.run.sandbox.limits import MIB, TreeLimits
from autograder.submission.intake.files import MAX_FILES, MAX_READ_BYTES, MAX_TOTAL_BYTES
from autograder.submission.intake.notebooks import MAX_CELLS, MAX_VALUES

HEAD = """# Limits by kind

What a submission may use, what keeps the limit, and where that is tested. `make docs` writes this page from
 the values in the code, most of them in `autograder/run/sandbox/limits.py`.
"""
FOOT = """
Where an ordinary user grades, all cells are the same user of the machine. What the kernel counts by user and no row
names, such as memory of pipes and watches of epoll, is shared by all of them. Root gives each cell a user of its own.
"""
ARGUMENTS, SANDBOX, WALLS, INSTALLED = "test_bubblewrap", "test_sandbox", "test_walls", "test_installed"
ANSWER = "test_answer"


def current() -> str:
    """Return the page as it should be."""
    return "\n".join([HEAD, *table(("what", "limit", "kept by", "test"), list(rows())), FOOT.strip() + "\n"])


def rows() -> list[tuple[str, str, str, str]]:
    """Return the rows: what, the limit, what keeps it, and the file of a test."""
    node, build, cell = limits.NODE, limits.BUILD, limits.GRADING_CELL
    forbidden = ", ".join(name for name in seccomp.FORBIDDEN if name in ("memfd_create", "shmget", "msgget", "add_key"))
    return [
        (
            "real time of a submission",
            f"{cell.wall_seconds:.0f} s for all tries",
            "its worker's starter",
            "test_time_budget",
        ),
        ("waiting for its nodes' answers", f"{HELD_SECONDS:.0f} s in all", "the worker", "test_patience"),
        (
            "real time of a build; of a node",
            f"{build.wall_seconds:.0f} s; {node.wall_seconds:.0f} s",
            "a watcher",
            SANDBOX,
        ),
        (
            "processor time of a process",
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
        ("memory of a cell", _mib(cell.memory), "a watcher, a control group", SANDBOX),
        ("threads of a program", f"{node.threads}", f"a watcher; the kernel at {node.tasks}", SANDBOX),
        ("descriptors of a process", f"{node.open_files}", "the kernel", SANDBOX),
        (
            "descriptors on their way",
            f"{node.open_files} and one message more",
            "the kernel, by the row above",
            SANDBOX,
        ),
        (
            "instances of inotify; watches",
            f"{limits.INOTIFY_INSTANCES}; {limits.INOTIFY_WATCHES} a cell",
            "its user namespace",
            SANDBOX,
        ),
        ("queued signals", f"{limits.SIGNALS}", "the kernel", ARGUMENTS),
        ("keys, queues, segments, files in memory", "none", f"a filter of calls ({forbidden}, …)", SANDBOX),
        ("size of a file; new files", f"{_mib(node.file_size)}; {node.files:,}", "the kernel; a watcher", SANDBOX),
        ("/tmp and /dev/shm of a program", _mib(node.scratch), "a file system in memory", SANDBOX),
        ("a cell's scratch folder", _mib(limits.CELL_SCRATCH), "a file system in memory", ARGUMENTS),
        ("what is printed", f"{_mib(node.output)}; {_mib(build.output)} in a build", "a watcher", SANDBOX),
        (
            "what is handed in",
            f"{MAX_FILES} files, {_mib(MAX_TOTAL_BYTES)}, {_mib(MAX_READ_BYTES)} unpacked",
            "intake",
            "test_intake",
        ),
        (
            "a submitted notebook",
            f"{MAX_CELLS:,} cells, {MAX_VALUES:,} commas and brackets",
            "intake",
            "test_costs",
        ),
        ("what a build installs", _tree(limits.INSTALLED), "a look at it before it is copied", INSTALLED),
        ("kinds of files in it", "files, folders, links inside", "a look at it before it is copied", INSTALLED),
        ("sources of messages that are kept", _tree(limits.SOURCES), "who keeps them", INSTALLED),
        (f"the cache `{CACHE}`", f"{_mib(LIMIT)}, and what is in use", "its eviction", "test_cache"),
        (
            "a message of a program in lockstep",
            f"{MAX_LINE // 1024} KiB, and one reading more",
            "the worker",
            "test_stepper",
        ),
        ("what a launch says of its end", f"{MAX_STATUS} bytes", "the worker", "test_launch_status"),
        (
            "a path in it; all of them",
            f"{limits.INSTALLED.path} bytes; {_mib(limits.INSTALLED.paths)}",
            "a look at it before it is copied",
            "test_bundle_worker",
        ),
        ("a message of a worker", _mib(limits.MESSAGE), "who started it", WALLS),
        ("files of a result", _tree(limits.RESULT_FILES), "who started the worker", WALLS),
        (
            "`result.json`; its values, a run's; a notebook's",
            f"{_mib(MAX_RESULT)}; {RESULT_VALUES:,}, {RUN_VALUES:,}; {NOTEBOOK_VALUES:,}",
            "who started the worker, before it parses them",
            ANSWER,
        ),
        ("an executed notebook", f"{_mib(MAX_BYTES)}, or it has no outputs", "the worker", ANSWER),
        ("pictures and runs on a page", _mib(MAX_SHOWN), "who started the worker", ANSWER),
    ]


def _mib(size: int) -> str:
    return f"{size // MIB:,} MiB"


def _tree(tree: TreeLimits) -> str:
    return f"{tree.names:,} names, {_mib(tree.size)}, holes counted"
