"""A content-addressed cache of built folders. Each is built once and added atomically. Their total size is limited.

An entry is a folder named after its key, beside a lock file. Processes that use, build or evict the entry hold the
lock. The kernel releases locks when a process dies, and a half-built folder never has an entry's name. If the entries
exceed the limit, those that are not in use are removed, large ones first. So a few large entries of one student do not
replace those that a class shares.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import re
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from autograder.run.sandbox.limits import MIB

LIMIT = 512 * MIB  # for all entries together
LARGE = 1 / 32  # share of the limit above which an entry is large: 16 MiB; the course's message packages need 2 MiB
_KEY = re.compile(r"[0-9a-f]{16,64}")


class Cache:
    """A cache in a private folder of this user. `limit` is the maximum number of bytes in all its entries."""

    def __init__(self, root: Path, limit: int = LIMIT) -> None:
        self.root, self._limit = root, limit

    @classmethod
    def default(cls, name: str) -> Cache:
        """Return this user's cache called `name`, below `XDG_CACHE_HOME` or, if that fails, in a temporary folder."""
        for base in (_user_cache_folder(), Path(tempfile.gettempdir()) / f"autograder-cache-{os.getuid()}"):
            root = base / "autograder" / name
            with contextlib.suppress(OSError):
                root.mkdir(parents=True, exist_ok=True, mode=0o700)
                if root.stat().st_uid == os.getuid() and os.access(root, os.W_OK | os.X_OK):
                    return cls(root)
        return cls(Path(tempfile.mkdtemp(prefix="autograder-cache-")))

    def get(self, key: str, make: Callable[[Path], None]) -> Path:
        """Return the folder of an entry, as `use` yields it. The folder exists at least until another entry is made."""
        with self.use(key, make) as entry:
            return entry

    @contextlib.contextmanager
    def use(self, key: str, make: Callable[[Path], None]) -> Iterator[Path]:
        """Yield the folder of an entry, which is not evicted during the block. Make the entry if it does not exist.

        Args:
            key: 16 to 64 hexadecimal digits.
            make: fills the given new folder. If it raises an exception, no entry is added.
        """
        self.root.mkdir(parents=True, exist_ok=True, mode=0o700)
        entry, is_new = self.root / key, False
        with self._lock(key) as lock:
            fcntl.flock(lock, fcntl.LOCK_SH)
            while not entry.is_dir():
                fcntl.flock(lock, fcntl.LOCK_EX)  # other processes wait here until the entry exists
                if not entry.is_dir():
                    self._make(entry, make)
                    is_new = True
                fcntl.flock(lock, fcntl.LOCK_SH)  # for a moment, the lock is free and the entry may be evicted
            os.utime(entry)
            if is_new:
                self._evict()
            yield entry

    @contextlib.contextmanager
    def _lock(self, key: str) -> Iterator[int]:
        lock = os.open(self.root / f"{key}.lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        try:
            yield lock
        finally:
            os.close(lock)

    def _make(self, entry: Path, make: Callable[[Path], None]) -> None:
        folder = Path(tempfile.mkdtemp(prefix=f".{entry.name}-", dir=self.root))
        try:
            make(folder)
            folder.rename(entry)
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def _evict(self) -> None:
        """Remove entries until the others fit, and the unfinished folders of killed builds.

        Large entries come first, and among equals those that were used least recently.
        """
        entries: list[tuple[bool, float, int, Path]] = []
        for folder in self.root.iterdir():
            with contextlib.suppress(FileNotFoundError):
                if folder.name.startswith("."):
                    self._remove(folder, folder.name[1:].partition("-")[0])
                elif _KEY.fullmatch(folder.name):
                    size = _size(folder)
                    entries.append((size <= LARGE * self._limit, folder.stat().st_mtime, size, folder))
        total = sum(size for _, _, size, _ in entries)
        for _, _, size, folder in sorted(entries):
            if total <= self._limit:
                return
            if self._remove(folder, folder.name):
                total -= size

    def _remove(self, folder: Path, key: str) -> bool:
        """Remove a folder unless its entry is in use or being made. Return whether the folder no longer exists."""
        with self._lock(key) as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                # It is renamed first, so that an interrupted removal does not leave half an entry.
                doomed_folder = folder.with_name(f".{key}-{os.getpid()}-{time.monotonic_ns()}")
                folder.rename(doomed_folder)
            except FileNotFoundError:
                return True
            except BlockingIOError:
                return False
            shutil.rmtree(doomed_folder, ignore_errors=True)
            return True


def _user_cache_folder() -> Path:
    folder = os.environ.get("XDG_CACHE_HOME", "")
    return Path(folder) if folder.startswith("/") else Path(os.environ.get("HOME", "/nonexistent")) / ".cache"


def _size(folder: Path) -> int:
    return sum(path.lstat().st_size for path in folder.rglob("*") if not path.is_symlink())
