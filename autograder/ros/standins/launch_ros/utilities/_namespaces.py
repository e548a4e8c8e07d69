"""Joining namespaces: a relative one is appended to the current one, an absolute one replaces it."""

from __future__ import annotations


def is_namespace_absolute(ns: str) -> bool:
    """Return whether `ns` begins with a slash."""
    return ns.startswith("/")


def make_namespace_absolute(ns: str | None) -> str | None:
    """Return `ns` with a leading slash, or None for None."""
    return ns if ns is None or is_namespace_absolute(ns) else f"/{ns}"


def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None:
    """Return `ns` appended to `base_ns`; either may be None, and an absolute `ns` is returned without `base_ns`."""
    if ns is None:
        return base_ns
    if base_ns is None or is_namespace_absolute(ns):
        combined = ns
    elif not ns:
        combined = base_ns
    else:
        combined = f"{base_ns.rstrip('/')}/{ns}"
    return combined if combined == "/" else combined.rstrip("/")
