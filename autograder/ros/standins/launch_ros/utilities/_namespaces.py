"""How namespaces are put together: a relative one goes below what was pushed, an absolute one stands alone."""

from __future__ import annotations


def is_namespace_absolute(ns: str) -> bool:
    """Whether `ns` begins with a slash."""
    return ns.startswith("/")


def make_namespace_absolute(ns: str | None) -> str | None:
    """Return `ns` with a slash before it, unless it is None or absolute already."""
    return ns if ns is None or is_namespace_absolute(ns) else f"/{ns}"


def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None:
    """Return `ns` below `base_ns`; either may be None, and an absolute `ns` is returned as it is."""
    if ns is None:
        return base_ns
    if base_ns is None or is_namespace_absolute(ns):
        combined = ns
    elif not ns:
        combined = base_ns
    else:
        combined = f"{base_ns.rstrip('/')}/{ns}"
    return combined if combined == "/" else combined.rstrip("/")
