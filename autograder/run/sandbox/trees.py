"""Lists, bounds and copies files that untrusted code wrote, on their way out of a sandbox.

Sizes are apparent sizes. A sparse file needs no space where it is written, but its full size where it is copied.
"""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Callable, Container, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from autograder.run.sandbox.limits import MIB, TreeLimits

Ignored = Callable[[Sequence[str]], Container[str]]
_CHUNK = 1 << 20
_CHANGED = (errno.ENOENT, errno.ENOTDIR, errno.ELOOP, errno.ENXIO)  # the file was replaced after it was listed
_UNFOLLOWED = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC


class TreeError(Exception):
    """A tree exceeds a limit, or contains something except files, folders and inner links. The message says what."""


@dataclass(frozen=True)
class Entry:
    """One name in a tree: a file, a folder or a link."""

    path: str  # below the root
    kind: str  # "file", "folder" or "link"
    executable: bool = False
    size: int = 0  # apparent bytes


def survey(root: Path, limits: TreeLimits) -> tuple[Entry, ...]:
    """List a tree, folders before their content, without opening any file.

    Raises:
        TreeError: it is larger than `limits`, nested deeper, or holds a device, a FIFO, a socket, or a link that leads
            out of it or goes round in circles.
    """
    entries, total, text = [], 0, 0
    for entry in _walk(root, "", limits.depth):
        entries.append(entry)
        total += entry.size
        if len(entries) > limits.names:
            raise TreeError(f"more than {limits.names} files and folders")
        if total > limits.size:
            raise TreeError(f"files of more than {limits.size // MIB} MiB in all, holes in them counted")
        length = len(os.fsencode(entry.path))
        text += length
        if length > limits.path or text > limits.paths:
            most = f"{limits.path} bytes" if length > limits.path else f"{limits.paths} bytes with all others"
            raise TreeError(f"{root.name}/{entry.path[:200]}, whose path has more than {most}")
        if entry.kind == "link" and not _leads_inside(root, root / entry.path):
            raise TreeError(f"{root.name}/{entry.path[:200]}, which leads out of the install space")
    return tuple(entries)


def read_tree(root: Path, limits: TreeLimits) -> dict[Entry, bytes]:
    """Read a whole tree: the content of each file, and the target of each link, relative to its folder.

    Raises:
        TreeError: as in `survey`, or it contains an unreadable file.
    """
    try:
        read = ((entry, _read(root / entry.path, entry)) for entry in survey(root, limits))
        return {replace(entry, size=len(data)): data for entry, data in read}
    except OSError as error:
        name = f"{root.name}/{os.path.relpath(error.filename or root, root)[:200]}"
        raise TreeError(f"{name}, which cannot be read ({error.strerror})") from None


def _read(path: Path, entry: Entry) -> bytes:
    if entry.kind == "file":
        return _read_file(path, entry.size)
    return _relative(path) if entry.kind == "link" else b""


def _relative(link: Path) -> bytes:
    """Return where a link leads, from its own folder: an absolute one would lead elsewhere in a copy of the tree."""
    target = link.readlink()
    if target.is_absolute():
        target = Path(os.path.relpath(os.path.realpath(target), os.path.realpath(link.parent)))
    return os.fsencode(target)


def _walk(root: Path, below: str, depth: int) -> Iterator[Entry]:
    try:
        with os.scandir(root / below) as names:
            listed = sorted(names, key=lambda name: name.name)
    except OSError as error:
        raise TreeError(f"{root.name}/{below[:200]}, which cannot be read ({error.strerror})") from None
    for name in listed:
        path = f"{below}/{name.name}" if below else name.name
        try:
            info = name.stat(follow_symlinks=False)
        except OSError as error:
            raise TreeError(f"{root.name}/{path[:200]}, which cannot be read ({error.strerror})") from None
        if stat.S_ISLNK(info.st_mode):
            yield Entry(path, "link")
        elif stat.S_ISREG(info.st_mode):
            yield Entry(path, "file", bool(info.st_mode & stat.S_IXUSR), info.st_size)
        elif stat.S_ISDIR(info.st_mode):
            if not depth:
                raise TreeError(f"{root.name}/{path[:200]}, which is nested too deep")
            yield Entry(path, "folder")
            yield from _walk(root, path, depth - 1)
        else:
            kind = {stat.S_IFIFO: "a FIFO", stat.S_IFSOCK: "a socket"}.get(stat.S_IFMT(info.st_mode), "a device")
            raise TreeError(f"{root.name}/{path[:200]}, which is {kind}")


def _leads_inside(root: Path, link: Path) -> bool:
    try:
        link.stat()  # raises at a loop of links, which `resolve` has not done since Python 3.13
    except FileNotFoundError:
        pass
    except OSError:
        return False
    try:
        return link.resolve().is_relative_to(root.parent.resolve() / root.name)
    except (OSError, RuntimeError):  # a name too long, a loop of links
        return False


def _read_file(path: Path, size: int) -> bytes:
    """Read a plain file of at most `size` bytes, and nothing that has taken its place since it was listed."""
    with os.fdopen(os.open(path, _UNFOLLOWED), "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise TreeError(f"{path.name} is no longer a plain file")
        data = file.read(size + 1)
    if len(data) > size:
        raise TreeError(f"{path.name} grows")
    return data


def copy_unread(source: Path, target: Path, limits: TreeLimits, ignored: Ignored) -> None:
    """Copy a submission for a reader that may not reach it, without following links or reading archives.

    The copy is refused for the same reasons as the original. Links stay links, devices and pipes become pipes. Files
    larger than `limits` keep their size but not their content, so that the reader rejects them. `ignored` returns the
    names of a folder to leave out. Each folder is opened from its parent, so a path may have any length.
    Files that change meanwhile are left out: no folder of the path `source` was a link, and none may have become one.
    """
    with _unless_changed(), _opened_unfollowed(source.parent) as old, _opened(target.parent) as new:
        _copy(_Pair(old, source.name, new, target.name), _Left(limits), ignored, limits.depth)


@dataclass
class _Left:
    limits: TreeLimits

    def __post_init__(self) -> None:
        self.names, self.size = self.limits.names, self.limits.size


@dataclass(frozen=True)
class _Pair:
    """A name in an open folder, and the name of its copy in another."""

    old: int
    name: str
    new: int
    copy: str


def _copy(pair: _Pair, left: _Left, ignored: Ignored, depth: int) -> None:
    info = os.stat(pair.name, dir_fd=pair.old, follow_symlinks=False)
    left.names -= 1
    if stat.S_ISLNK(info.st_mode):
        os.symlink(os.readlink(pair.name, dir_fd=pair.old), pair.copy, dir_fd=pair.new)
    elif stat.S_ISREG(info.st_mode):
        _copy_file(pair, left)
    elif stat.S_ISDIR(info.st_mode):
        os.mkdir(pair.copy, 0o755, dir_fd=pair.new)
        with _opened(pair.name, pair.old) as old, _opened(pair.copy, pair.new) as new:
            names = sorted(os.listdir(old)) if depth else []
            skipped = ignored(names)
            for name in names:
                if name not in skipped and left.names > 0:
                    with _unless_changed():
                        _copy(_Pair(old, name, new, name), left, ignored, depth - 1)
    else:
        os.mkfifo(pair.copy, dir_fd=pair.new)


@contextmanager
def _unless_changed() -> Iterator[None]:
    try:
        yield
    except OSError as error:
        if error.errno not in _CHANGED:
            raise


def _copy_file(pair: _Pair, left: _Left) -> None:
    fresh = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC
    with (
        os.fdopen(os.open(pair.name, _UNFOLLOWED, dir_fd=pair.old), "rb") as old,
        os.fdopen(os.open(pair.copy, fresh, 0o644, dir_fd=pair.new), "wb") as new,
    ):
        info = os.fstat(old.fileno())
        if not stat.S_ISREG(info.st_mode):
            return
        os.fchmod(new.fileno(), 0o644 | info.st_mode & 0o111)
        if info.st_size > left.size:
            new.truncate(info.st_size)
            left.size = 0
            return
        left.size -= info.st_size
        rest = info.st_size
        while rest and (chunk := old.read(min(rest, _CHUNK))):
            new.write(chunk)
            rest -= len(chunk)


@contextmanager
def _opened_unfollowed(folder: Path) -> Iterator[int]:
    """Open a folder by an absolute path, without following links."""
    with ExitStack() as stack:
        descriptor = stack.enter_context(_opened(folder.anchor or "."))
        for part in folder.relative_to(folder.anchor).parts:
            descriptor = stack.enter_context(_opened(part, descriptor))
        yield descriptor


@contextmanager
def _opened(folder: Path | str, within: int | None = None) -> Iterator[int]:
    """Open a folder; one within another is not followed if a link has taken its place."""
    flags = os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC | (0 if within is None else os.O_NOFOLLOW)
    descriptor = os.open(folder, flags, dir_fd=within)
    try:
        yield descriptor
    finally:
        os.close(descriptor)
