"""Programs that try to escape from a sandbox. Each prints a line that begins with `OUT` for each thing that it reached.

`exit_reasons` lists the exit reasons that count as contained. An endless program must be stopped by a limit of the
sandbox. A program that exceeds a limit without being stopped counts as escaped.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from autograder import course_paths
from autograder.run.fork_server import seccomp
from autograder.run.sandbox import ExitReason, Limits
from autograder.run.sandbox.limits import GIB, MIB

CANARY = "CANARY-of-the-grader"  # a secret in the environment and the memory of the process that tries the escapes
LIMITS = Limits(wall_seconds=20.0, threads=40, memory=200 * MIB, output=50_000, scratch=4 * MIB)
_LONG_LIMITS = replace(LIMITS, wall_seconds=120.0)
_SHORT_LIMITS, _HUGE_LIMITS = replace(LIMITS, wall_seconds=1.0), replace(LIMITS, memory=4 * GIB)
_SOCKETS_LIMITS = replace(LIMITS, memory=600 * MIB)  # more memory than the processes of `_SOCKETS` map


@dataclass(frozen=True)
class Escape:
    """A program that tries to escape. The tests and `autograder doctor --security` run it."""

    id: str
    description: str  # the attempt, to complete the sentence "a program cannot ..."
    code: str
    limits: Limits = LIMITS
    network: bool = False
    exit_reasons: tuple[ExitReason, ...] = (ExitReason.EXITED,)

    @property
    def program(self) -> str:
        """The code, after a definition of HIDDEN: the folders of the course that no program may read."""
        return f"HIDDEN = {[*map(str, (*course_paths.check_folders(), course_paths.SOLUTIONS))]}\n{self.code}"


_READ = """
import os
for path in HIDDEN:
    if any(files for _, _, files in os.walk(path)):
        print("OUT", path)
for path in ("/root", "/home", "/etc/shadow", "/etc/passwd", "/var", "/run", "/sys", "/boot"):
    if os.path.exists(path):
        print("OUT", path)
"""
_PROCESSES = f"""
import glob, os
seen = glob.glob("/proc/[0-9]*")
if len(seen) > 4:  # bubblewrap, itself, at most two helpers
    print("OUT", seen)
for path in [p + f for p in seen for f in ("/environ", "/cmdline")] + ["/proc/self/environ"]:
    try:
        if {CANARY[:6]!r} + {CANARY[6:]!r} in open(path, errors="replace").read():
            print("OUT", path)
    except OSError:
        pass
if len(os.listdir("/proc/self/fd")) > 4:  # 3 is the listing itself
    print("OUT descriptors", os.listdir("/proc/self/fd"))
"""
_MEMORY = f"""
import ctypes, glob, os
word = {CANARY[:6]!r}.encode() + {CANARY[6:]!r}.encode()
for process in set(glob.glob("/proc/[0-9]*")) - {{f"/proc/{{os.getpid()}}"}}:
    try:
        with open(process + "/maps") as maps, open(process + "/mem", "rb", 0) as memory:
            for line in maps:
                start, end = (int(part, 16) for part in line.split()[0].split("-"))
                if line.split()[1].startswith("r") and end < 1 << 47:
                    memory.seek(start)
                    if word in memory.read(end - start):
                        print("OUT", process)
    except OSError:
        pass
libc = ctypes.CDLL(None)
for pid in (os.getppid(), 1, OUTSIDE):
    if libc.ptrace(16, pid, 0, 0) == 0:
        print("OUT ptrace", pid)
"""
_SIGNALS = """
import os, signal
for pid in (OUTSIDE, os.getppid()):
    try:
        if pid > 1:  # 0, a parent outside, would be the program's own group
            os.kill(pid, signal.SIGSTOP)
            print("OUT", pid)
    except OSError:
        pass
"""
_NETWORK = """
import socket
if {name for _, name in socket.if_nameindex()} != {"lo"}:
    print("OUT", socket.if_nameindex())
for address in (("127.0.0.1", PORT), ("1.1.1.1", 53), ("192.168.0.1", 80)):
    try:
        socket.create_connection(address, timeout=3)
        print("OUT", address)
    except OSError:
        pass
try:
    socket.socket(40, socket.SOCK_STREAM)  # AF_VSOCK: a virtual machine's host
    print("OUT vsock")
except OSError:
    pass
"""
_WRITE = f"""
import os
for folder in ("/", "/usr", "/etc", "/dev", "/proc", "/proc/sys/kernel", {str(course_paths.ROOT / "autograder")!r}):
    try:
        open(folder + "/probe", "w").close()
        print("OUT", folder)
    except OSError:
        pass
"""
_SETTINGS = """
import os
writable = {os.getcwd(), "/tmp", "/dev/shm", "/dev/pts"}
writable |= {f"/dev/{name}" for name in ("null", "zero", "full", "random", "urandom", "tty", "console", "ptmx")}
devices = {os.stat(folder).st_dev for folder in ("/", "/dev")}  # of the folders in which single files are mounted
pending = ["/"]
while pending:
    folder = pending.pop()
    try:
        entries = list(os.scandir(folder))
        is_read_only = os.statvfs(folder).f_flag & os.ST_RDONLY and os.stat(folder).st_dev not in devices
    except OSError:
        continue
    for entry in entries:
        if entry.path in writable or entry.is_symlink():
            continue
        if entry.is_dir():
            pending.append(entry.path)
        elif not (is_read_only and entry.is_file()):
            try:
                os.close(os.open(entry.path, os.O_WRONLY | os.O_NONBLOCK | os.O_NOCTTY))
                print("OUT", entry.path)
            except OSError:
                pass
for path in ("/proc/sys/kernel/core_pattern", "/proc/sys/vm/overcommit_memory", "/proc/self/oom_score_adj"):
    try:
        value = open(path).read()
        with open(path, "w") as setting:
            setting.write(value)
        print("OUT wrote", path)
    except OSError:
        pass
"""
_INOTIFY = """
import ctypes
libc, count = ctypes.CDLL(None), 0
while libc.inotify_init() >= 0: count += 1
if count > 32:
    print("OUT", count)
"""
_IN_FLIGHT = """
import array, os, socket
def fill():
    pairs = [socket.socketpair() for _ in range(60)]
    sent, descriptors = 0, array.array("i", [0] * 250)
    try:
        for near, _ in pairs:
            near.sendmsg([b"x"], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, descriptors)])
            sent += len(descriptors)
    except OSError:
        pass
    return sent, pairs
total, open_pairs = fill()
if total > 900:
    print("OUT", total)
"""
_CALLS = f"""
import ctypes
libc = ctypes.CDLL(None)
for name, number in {seccomp.FORBIDDEN}.items():
    if libc.syscall(number, 0, 0, 0, 0, 0) >= 0:
        print("OUT", name)
for flag in {[1 << bit for bit in range(32) if seccomp.NEW_NAMESPACES >> bit & 1]}:
    if libc.syscall({seccomp.CLONE}, flag | 17, 0, 0, 0, 0) >= 0:
        print("OUT clone", flag)
if libc.mount(b"none", b"/tmp", b"tmpfs", 0, None) == 0:
    print("OUT mount")
"""
_FILL = """
for folder in ("/tmp", "/dev/shm"):
    written = 0
    try:
        for number in range(100):
            with open(f"{folder}/{number}", "wb", buffering=0) as stream:
                written += stream.write(bytes(1 << 20))
        print("OUT", folder, written)
    except OSError:
        pass
"""
_FILES = "import itertools\nfor n in itertools.count(): open(f'/tmp/{n}', 'w').close()"
_USE_MEMORY = "blocks = []\nwhile True: blocks.append(bytearray(b'x') * (1 << 20))"
_UNMAPPED = """
import mmap, os, ctypes
try:
    file = os.memfd_create("flood")
    for _ in range(1000):
        os.write(file, bytes(1 << 20))
    print("OUT memfd")
except OSError:
    pass
libc = ctypes.CDLL(None)
if libc.shmget(0, 1 << 30, 0o1600) >= 0:
    print("OUT System V")
"""
_SOCKETS = """
import os, socket
def fill():
    buffered, sockets = 0, []
    try:
        while buffered < 200 << 20:
            sockets += socket.socketpair()
            for each in sockets[-2:]:
                each.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 20)
                each.setblocking(False)
                try:
                    while True: buffered += each.send(bytes(65536))
                except BlockingIOError:
                    pass
    except OSError:  # no more descriptors
        pass
    return buffered, sockets
reader, writer = os.pipe()
children = []
while len(children) < 8 and 0 not in children: children.append(os.fork())
if 0 in children:
    buffered, sockets = fill()
    os.write(writer, b"%d " % buffered)
    import signal; signal.pause()
os.close(writer)
sums = b""
while sums.count(b" ") < 8: sums += os.read(reader, 64)
total = sum(map(int, sums.split()))
if total > 1400 << 20:
    print("OUT", total >> 20, "MiB")
for child in children: os.kill(child, 9)
"""
_FORKS = "import os\nwhile True:\n    try: os.fork()\n    except OSError: pass"
_THREADS = "import threading\nwhile True: threading.Thread(target=threading.Event().wait).start()"
_IGNORE_SIGNALS = """
import signal
for n in range(1, 65):
    try: signal.signal(n, signal.SIG_IGN)
    except (OSError, ValueError): pass
while True: signal.pause()
"""
_DAEMON = """
import os, signal
for _ in range(2):
    if os.fork(): os._exit(0)
    os.setsid()
while True: signal.pause()
"""

ESCAPES = (
    Escape("files", "read hidden checks, solutions, accounts or homes", _READ),
    Escape("processes", "see other processes, or the grader's environment and descriptors", _PROCESSES),
    Escape("memory", "read the memory of another process, or trace it", _MEMORY),
    Escape("signals", "stop the grader or another process outside", _SIGNALS),
    Escape("network", "reach a network or the machine's own ports", _NETWORK),
    Escape("loopback", "reach anything but the grader if it has a network", _NETWORK, network=True),
    Escape("writing", "write to the system, the kernel's settings or the grader", _WRITE),
    Escape("settings", "open a file outside of its folders for writing", _SETTINGS, _LONG_LIMITS),
    Escape("inotify", "exhaust the inotify instances of the machine's user", _INOTIFY),
    Escape("descriptors", "exhaust the number of descriptors in flight", _IN_FLIGHT),
    Escape("calls", "create namespaces or mounts, use keys, trace, or load programs into the kernel", _CALLS),
    Escape("disk", "fill more than its own /tmp and /dev/shm", _FILL),
    Escape("inodes", "create files without end", _FILES, exit_reasons=(ExitReason.FILES, ExitReason.MEMORY)),
    Escape("memory eater", "use memory without end", _USE_MEMORY, exit_reasons=(ExitReason.MEMORY,)),
    Escape("unmapped memory", "hold memory that belongs to no process", _UNMAPPED),
    Escape(
        "socket buffers", "hold memory in socket buffers", _SOCKETS, _SOCKETS_LIMITS, exit_reasons=(ExitReason.MEMORY,)
    ),
    Escape("fork bomb", "start processes without end", _FORKS, _HUGE_LIMITS, exit_reasons=(ExitReason.THREADS,)),
    Escape("thread bomb", "start threads without end", _THREADS, exit_reasons=(ExitReason.THREADS,)),
    Escape("output", "print without end", "while True: print('x' * 99)", exit_reasons=(ExitReason.OUTPUT,)),
    Escape("endless loop", "run without end", "while True: pass", _SHORT_LIMITS, exit_reasons=(ExitReason.WALL_TIME,)),
    Escape(
        "ignored signals",
        "survive by ignoring every signal",
        _IGNORE_SIGNALS,
        _SHORT_LIMITS,
        exit_reasons=(ExitReason.WALL_TIME,),
    ),
    Escape("daemon", "survive by setsid and two forks", _DAEMON),
)
