"""The command line of a sandbox: its mounts, hidden folders, namespaces and limits."""

from __future__ import annotations

import itertools
import sys
from pathlib import Path

from autograder import course_paths
from autograder.run.sandbox import Limits, Mount, Sandbox, bubblewrap
from autograder.run.sandbox.limits import WORKER_SCRATCH
from autograder.run.sandbox.spec import View


def _pairs(arguments: list[str], flag: str) -> list[str]:
    return [value for name, value in itertools.pairwise(arguments) if name == flag]


def _options(arguments: list[str]) -> list[str]:
    return arguments[: arguments.index("--")]


def _sandbox(spec: Sandbox) -> list[str]:
    return bubblewrap.sandbox(["true"], spec, 9)


def test_a_sandbox_has_separate_namespaces_and_no_privileges(tmp_path: Path) -> None:
    options = _options(_sandbox(Sandbox(tmp_path)))
    for flag in ("--unshare-user", "--unshare-pid", "--unshare-ipc", "--unshare-uts", "--new-session"):
        assert flag in options
    assert "--die-with-parent" in options
    assert _pairs(options, "--cap-drop") == ["ALL"]
    assert _pairs(options, "--seccomp") == ["9"]


def test_a_sandbox_has_no_network_unless_it_is_asked_for(tmp_path: Path) -> None:
    assert "--unshare-net" in _options(_sandbox(Sandbox(tmp_path)))
    assert "--unshare-net" not in _options(_sandbox(Sandbox(tmp_path, network=True)))


def test_the_environment_is_cleared_before_it_is_set(tmp_path: Path) -> None:
    options = _options(_sandbox(Sandbox(tmp_path, environment={"LANG": "C.UTF-8"})))
    assert options.index("--clearenv") < options.index("--setenv")
    assert options[options.index("--setenv") + 1 :][:2] == ["LANG", "C.UTF-8"]


def test_no_accounts_and_no_home_folders_are_shown(tmp_path: Path) -> None:
    options = _options(_sandbox(Sandbox(tmp_path)))
    mounted_paths = {Path(path) for flag in ("--bind", "--ro-bind", "--dev-bind") for path in _pairs(options, flag)}
    python = set(bubblewrap.python_mounts())
    for secret in ("/", "/root", "/home", "/etc", "/etc/shadow", "/etc/passwd", "/var", "/run", "/sys"):
        assert Path(secret) not in mounted_paths - python
    assert not any(course_paths.ROOT.is_relative_to(path) for path in mounted_paths)


def test_suites_and_solutions_are_hidden_in_each_mount_that_contains_them(tmp_path: Path) -> None:
    spec = Sandbox(tmp_path, mounts=(Mount(course_paths.ROOT),))
    options = _options(_sandbox(spec))
    mounted = options.index(str(course_paths.ROOT))
    for secret in (*course_paths.check_folders(), course_paths.SOLUTIONS):
        assert options.index(str(secret)) > mounted
        assert str(secret) in _pairs(options, "--tmpfs")
        assert str(secret) in _pairs(options, "--remount-ro")


def test_only_mounts_marked_as_writable_are_writable(tmp_path: Path) -> None:
    spec = Sandbox(tmp_path, mounts=(Mount(tmp_path / "in"), Mount(tmp_path / "out", writable=True)))
    options = _options(_sandbox(spec))
    assert _pairs(options, "--bind") == [str(tmp_path / "out")]
    assert str(tmp_path / "in") in _pairs(options, "--ro-bind")


def test_every_file_system_in_memory_has_a_size_or_is_read_only(tmp_path: Path) -> None:
    options = _options(_sandbox(Sandbox(tmp_path, limits=Limits(scratch=4096))))
    for path in ("/tmp", "/dev/shm"):
        index = next(i for i, pair in enumerate(itertools.pairwise(options)) if pair == ("--tmpfs", path))
        assert options[index - 2 : index] == ["--size", "4096"]
    assert {"/", "/dev", "/proc"} <= set(_pairs(options, "--remount-ro"))


def test_the_kernels_limits_are_set_inside_the_sandbox(tmp_path: Path) -> None:
    chosen = Limits(cpu_seconds=7, address_space=2**30, threads=10, file_size=99, open_files=33)
    arguments = bubblewrap.sandbox(["node", "--flag"], Sandbox(tmp_path, limits=chosen), 9)
    command = arguments[arguments.index("--") + 1 :]
    assert command[0] == "prlimit"
    assert command[-2:] == ["node", "--flag"]
    limits = (
        "--cpu=7:12",
        f"--as={2**30}:{2**30}",
        "--nproc=40:40",
        "--fsize=99:99",
        "--nofile=33:33",
        "--core=0:0",
        "--sigpending=1024:1024",
    )
    assert set(limits) <= set(command)


def test_the_grader_s_own_python_is_shown_read_only(tmp_path: Path) -> None:
    options = _options(_sandbox(Sandbox(tmp_path)))
    if not Path(sys.prefix).is_relative_to("/usr"):
        assert sys.prefix in _pairs(options, "--ro-bind")


def test_a_worker_sandbox_has_namespaces_and_a_scratch_folder_of_limited_size(tmp_path: Path) -> None:
    arguments = bubblewrap.worker_sandbox(["worker"], View(), scratch=tmp_path)
    options = _options(arguments)
    for flag in ("--unshare-net", "--unshare-user", "--unshare-pid", "--unshare-ipc"):
        assert flag in options
    index = options.index(str(tmp_path))
    assert options[index - 3 : index] == ["--size", str(WORKER_SCRATCH), "--tmpfs"]
    assert arguments[-1] == "worker"


def test_a_sandbox_of_root_becomes_an_ordinary_user_before_it_creates_namespaces(tmp_path: Path) -> None:
    arguments = bubblewrap.worker_sandbox(["worker"], View(), scratch=tmp_path, user=47001)
    assert "--unshare-user" not in _options(arguments)
    command = arguments[arguments.index("setpriv") :]
    assert {"--reuid=47001", "--regid=47001", "--clear-groups", "--no-new-privs"} <= set(command)
    assert command.index("--no-new-privs") < command.index("--unshare-user")


def test_a_worker_sandbox_shows_the_grader_s_code_and_only_the_declared_files_of_chapters(tmp_path: Path) -> None:
    solution, out = course_paths.SOLUTIONS / "speed_guard", tmp_path / "out"
    options = _options(
        bubblewrap.worker_sandbox(["worker"], View((solution,), (tmp_path,), (out,)), scratch=Path("/tmp/worker"))
    )
    read_only, writable = _pairs(options, "--ro-bind"), _pairs(options, "--bind")
    assert writable == [str(out)]
    assert {str(course_paths.ROOT / "autograder"), str(solution), str(tmp_path)} <= set(read_only)
    for secret in (
        course_paths.ROOT,
        course_paths.CHAPTERS,
        course_paths.SOLUTIONS,
        Path("/"),
        Path("/home"),
        Path("/etc"),
        Path("/run"),
    ):
        assert str(secret) not in read_only
    assert {*map(str, course_paths.check_folders())} <= set(_pairs(options, "--tmpfs")) & set(
        _pairs(options, "--remount-ro")
    )
