"""Modules that are ready, and not there: a program that imports one has it at once, one that does not lacks it.

    make_ready(["rclpy.node", "sensor_msgs.msg"])

What a program imports is most of what it computes until it spins, and a zygote can have imported it before. But a
program with `import sensor_msgs` and no `import sensor_msgs.msg` must fail as it does elsewhere. So these modules are
imported and taken away again, out of `sys.modules` and off their packages; when one is imported again, it comes back
as it was, and with it what it has imported itself.
"""

from __future__ import annotations

import builtins
import importlib
import inspect
import sys
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import resolve_name
from types import ModuleType
from typing import Any

Needs = dict[str, set[str]]


def make_ready(names: Iterable[str], warm: Callable[[], None] = lambda: None) -> None:
    """Import modules, those of them that there are, and take away what that has brought.

    Args:
        names: of the modules.
        warm: called while they are there.
    """
    before = set(sys.modules)
    with _recorded() as needs:
        for name in names:
            with suppress(ImportError):
                importlib.import_module(name)
    warm()
    _look_up()
    ready = {name: module for name, module in sys.modules.items() if name not in before and module is not None}
    sys.meta_path.insert(0, _Finder(ready, needs, {name for name in ready if _unbind(name, ready[name])}))
    for name in ready:
        del sys.modules[name]


class _Finder(MetaPathFinder, Loader):
    """Finds modules that are ready.

    Args:
        ready: those, by name.
        needs: by the name of each what it imports.
        bound: those that were an attribute of their package.
    """

    def __init__(self, ready: dict[str, ModuleType], needs: Needs, bound: set[str]) -> None:
        self.ready, self._needs, self._bound = ready, needs, bound

    def find_spec(self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> Any:
        """Return where the module is from, and that it is loaded from here."""
        own = getattr(self.ready.get(name), "__spec__", None)
        if own is None:
            return None
        spec = ModuleSpec(name, self, origin=own.origin, is_package=own.submodule_search_locations is not None)
        spec.submodule_search_locations, spec.cached = own.submodule_search_locations, own.cached
        spec.has_location = own.has_location
        spec.loader_state = own
        return spec

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Return the module, which has been loaded."""
        return self.ready[spec.name]

    def exec_module(self, module: ModuleType) -> None:
        """Let the module be there, as it was."""
        assert module.__spec__ is not None
        module.__spec__ = module.__spec__.loader_state
        waiting, seen = [module.__name__], set[str]()
        while waiting:
            name = waiting.pop()
            if name in seen:
                continue
            seen.add(name)
            waiting += self._needs.get(name, ())  # one that is there may have imported more for this one
            there, (parent, _, child) = self.ready.pop(name, None), name.rpartition(".")
            package = self.ready.get(parent) or sys.modules.get(parent)
            if there and sys.modules.setdefault(name, there) is there and package and name in self._bound:
                setattr(package, child, there)


@contextmanager
def _recorded() -> Iterator[Needs]:
    """Record by its name what each module imports."""
    needs: Needs = defaultdict(set)
    statement, function = builtins.__import__, importlib.import_module

    def note(importer: Any, name: str, items: Iterable[str] = ()) -> None:
        parts = name.split(".")
        whole = {".".join(parts[: count + 1]) for count in range(len(parts))}
        needs[str(importer)] |= whole | {f"{name}.{item}" for item in items}

    def imports(name: str, globals: Any = None, locals: Any = None, fromlist: Any = (), level: int = 0) -> ModuleType:
        module = statement(name, globals, locals, fromlist, level)
        here = globals or {}
        with suppress(ImportError, TypeError):
            absolute = resolve_name("." * level + name, here.get("__package__") or here.get("__name__"))
            note(here.get("__name__"), absolute, fromlist or ())
        return module

    def import_module(name: str, package: str | None = None) -> ModuleType:
        note(sys._getframe(1).f_globals.get("__name__"), resolve_name(name, package))
        return function(name, package)

    builtins.__import__, importlib.import_module = imports, import_module
    try:
        yield needs
    finally:
        builtins.__import__, importlib.import_module = statement, function


def _look_up() -> None:
    """Let `inspect` find out which file each module is from, and remember it.

    A program's first line of log does, since rclpy asks where it was written: 20 ms with some hundred modules.
    """
    inspect.getmodule(compile("", "a file of no module", "exec"))


def _unbind(name: str, module: ModuleType) -> bool:
    """Take a module off its package; return whether it was there."""
    package, _, child = name.rpartition(".")
    attributes = vars(sys.modules[package]) if package in sys.modules else {}
    if attributes.get(child) is not module:
        return False
    del attributes[child]
    return True
