"""Lists, limits and copies files that untrusted code wrote and that leave a sandbox.

Sizes are apparent sizes, because a sparse file needs no space where it is written, but its full size where it is
copied.
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
_CHANGED_ERRORS = (errno.ENOENT, errno.ENOTDIR, errno.ELOOP, errno.ENXIO)  # the file was replaced after it was listed
_NO_FOLLOW = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC


class TreeError(Exception):
    """A tree exceeds a limit, or contains anything but files, folders and inner links. The message says what."""


@dataclass(frozen=True)
class Entry:
    """One name in a tree: a file, a folder or a link."""

    path: str  # below the root
    kind: str  # "file", "folder" or "link"
    executable: bool = False
    size: int = 0  # apparent bytes


def list_tree(root: Path, limits: TreeLimits) -> tuple[Entry, ...]:
    """List a tree, folders before their content, without opening any file.

    Raises:
        TreeError: it exceeds `limits`, or contains a device, a FIFO, a socket, or a link that leads out of it or to
            itself.
    """
    entries, total, path_bytes = [], 0, 0
    for entry in _walk(root, "", limits.depth):
        entries.append(entry)
        total += entry.size
        if len(entries) > limits.names:
            raise TreeError(f"more than {limits.names} files and folders")
        if total > limits.size:
            raise TreeError(f"files of more than {limits.size // MIB} MiB in all, including holes")
        length = len(os.fsencode(entry.path))
        path_bytes += length
        if length > limits.path or path_bytes > limits.paths:
            limit = f"{limits.path} bytes" if length > limits.path else f"{limits.paths} bytes with all others"
            raise TreeError(f"{root.name}/{entry.path[:200]}, whose path has more than {limit}")
        if entry.kind == "link" and not _leads_inside(root, root / entry.path):
            raise TreeError(f"{root.name}/{entry.path[:200]}, which leads out of the install space")
    return tuple(entries)


def read_tree(root: Path, limits: TreeLimits) -> dict[Entry, bytes]:
    """Read a whole tree: the content of each file, and the target of each link, relative to its folder.

    Raises:
        TreeError: as in `list_tree`, or it contains an unreadable file.
    """
    try:
        contents = ((entry, _read(root / entry.path, entry)) for entry in list_tree(root, limits))
        return {replace(entry, size=len(data)): data for entry, data in contents}
    except OSError as error:
        name = f"{root.name}/{os.path.relpath(error.filename or root, root)[:200]}"
        raise TreeError(f"{name}, which cannot be read ({error.strerror})") from None


def _read(path: Path, entry: Entry) -> bytes:
    if entry.kind == "file":
        return _read_file(path, entry.size)
    return _relative(path) if entry.kind == "link" else b""


def _relative(link: Path) -> bytes:
    """Return the target of a link relative to its folder: an absolute link would lead elsewhere in a copy."""
    target = link.readlink()
    if target.is_absolute():
        target = Path(os.path.relpath(os.path.realpath(target), os.path.realpath(link.parent)))
    return os.fsencode(target)


def _walk(root: Path, folder: str, depth: int) -> Iterator[Entry]:
    try:
        with os.scandir(root / folder) as names:
            entries = sorted(names, key=lambda name: name.name)
    except OSError as error:
        raise TreeError(f"{root.name}/{folder[:200]}, which cannot be read ({error.strerror})") from None
    for name in entries:
        path = f"{folder}/{name.name}" if folder else name.name
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
                raise TreeError(f"{root.name}/{path[:200]}, which is nested too deeply")
            yield Entry(path, "folder")
            yield from _walk(root, path, depth - 1)
        else:
            kind = {stat.S_IFIFO: "a FIFO", stat.S_IFSOCK: "a socket"}.get(stat.S_IFMT(info.st_mode), "a device")
            raise TreeError(f"{root.name}/{path[:200]}, which is {kind}")


def _leads_inside(root: Path, link: Path) -> bool:
    try:
        link.stat()  # raises at a loop of links; `resolve` does not, since Python 3.13
    except FileNotFoundError:
        pass
    except OSError:
        return False
    try:
        return link.resolve().is_relative_to(root.parent.resolve() / root.name)
    except (OSError, RuntimeError):  # the name is too long, or links form a loop
        return False


def _read_file(path: Path, size: int) -> bytes:
    """Read a plain file of at most `size` bytes. Raise a TreeError if it has changed since it was listed."""
    with os.fdopen(os.open(path, _NO_FOLLOW), "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise TreeError(f"{path.name} is no longer a plain file")
        data = file.read(size + 1)
    if len(data) > size:
        raise TreeError(f"{path.name} has grown")
    return data


def copy_untrusted(source: Path, target: Path, limits: TreeLimits, ignored: Ignored) -> None:
    """Copy a submission for a reader that cannot access it, without following links or reading archives.

    Intake refuses the copy for the same reasons as the original. Links stay links, devices and pipes become pipes.
    Files that exceed `limits` keep their size but not their content, so that the reader rejects them. `ignored` gets
    the names in a folder, and returns those to leave out. Each folder is opened from its parent, so a path may have any
    length. Files that change meanwhile are left out. No folder in the path `source` was a link. If one has become a
    link, nothing is copied.
    """
    with _unless_changed(), _open_without_links(source.parent) as old, _open_folder(target.parent) as new:
        _copy(_Pair(old, source.name, new, target.name), _Remaining(limits), ignored, limits.depth)


@dataclass
class _Remaining:
    """How many names and bytes may still be copied."""

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


def _copy(pair: _Pair, remaining: _Remaining, ignored: Ignored, depth: int) -> None:
    info = os.stat(pair.name, dir_fd=pair.old, follow_symlinks=False)
    remaining.names -= 1
    if stat.S_ISLNK(info.st_mode):
        os.symlink(os.readlink(pair.name, dir_fd=pair.old), pair.copy, dir_fd=pair.new)
    elif stat.S_ISREG(info.st_mode):
        _copy_file(pair, remaining)
    elif stat.S_ISDIR(info.st_mode):
        os.mkdir(pair.copy, 0o755, dir_fd=pair.new)
        with _open_folder(pair.name, pair.old) as old, _open_folder(pair.copy, pair.new) as new:
            names = sorted(os.listdir(old)) if depth else []
            ignored_names = ignored(names)
            for name in names:
                if name not in ignored_names and remaining.names > 0:
                    with _unless_changed():
                        _copy(_Pair(old, name, new, name), remaining, ignored, depth - 1)
    else:
        os.mkfifo(pair.copy, dir_fd=pair.new)


@contextmanager
def _unless_changed() -> Iterator[None]:
    try:
        yield
    except OSError as error:
        if error.errno not in _CHANGED_ERRORS:
            raise


def _copy_file(pair: _Pair, remaining: _Remaining) -> None:
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC
    with (
        os.fdopen(os.open(pair.name, _NO_FOLLOW, dir_fd=pair.old), "rb") as old,
        os.fdopen(os.open(pair.copy, flags, 0o644, dir_fd=pair.new), "wb") as new,
    ):
        info = os.fstat(old.fileno())
        if not stat.S_ISREG(info.st_mode):
            return
        os.fchmod(new.fileno(), 0o644 | info.st_mode & 0o111)
        if info.st_size > remaining.size:
            new.truncate(info.st_size)
            remaining.size = 0
            return
        remaining.size -= info.st_size
        remaining_bytes = info.st_size
        while remaining_bytes and (chunk := old.read(min(remaining_bytes, _CHUNK))):
            new.write(chunk)
            remaining_bytes -= len(chunk)


@contextmanager
def _open_without_links(folder: Path) -> Iterator[int]:
    """Open a folder by an absolute path, without following links."""
    with ExitStack() as stack:
        descriptor = stack.enter_context(_open_folder(folder.anchor or "."))
        for part in folder.relative_to(folder.anchor).parts:
            descriptor = stack.enter_context(_open_folder(part, descriptor))
        yield descriptor


@contextmanager
def _open_folder(folder: Path | str, parent: int | None = None) -> Iterator[int]:
    """Open a folder. If it is given relative to the open folder `parent`, it must not be a link."""
    flags = os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC | (0 if parent is None else os.O_NOFOLLOW)
    descriptor = os.open(folder, flags, dir_fd=parent)
    try:
        yield descriptor
    finally:
        os.close(descriptor)
