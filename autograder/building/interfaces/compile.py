"""Compiles generated interface code with the system's gcc: few translation units, without optimisation."""

from __future__ import annotations

import os
import subprocess
import sysconfig
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy

from autograder.ros.environment import site_packages

FAST = "rosidl_typesupport_fastrtps_c"
INTROSPECTION = "rosidl_typesupport_introspection_c"
# The libraries that dependants link: an installed package has all of them, one that was built here the first two.
_LIBRARIES = (FAST, INTROSPECTION, "rosidl_generator_c", "rosidl_typesupport_c", "rosidl_generator_py")


def compile_package(
    package: str, prefix: Path, work: Path, prefixes: tuple[Path, ...], dependencies: tuple[str, ...]
) -> None:
    """Compile the generators' output in `work` into libraries and the extension module under `prefix`.

    The library of the Fast DDS type support holds everything but introspection: rcl asks for these two by name. It is
    the extension module, too, under a second name.

    Args:
        package: its name.
        prefix: where the libraries go.
        work: the folder with the generated code.
        prefixes: where other packages are found.
        dependencies: all interface packages below this one.
    """
    names = ("rosidl_generator_c", "rosidl_typesupport_c", FAST, INTROSPECTION)
    include = [f"-I{work / name}" for name in names]
    for root in prefixes:
        include += [f"-I{folder}" for folder in sorted((root / "include").glob("*/"))] + [f"-I{root / 'include'}"]
    include += [f"-I{sysconfig.get_paths()['include']}", f"-I{numpy.get_include()}"]
    flags = ["-O0", "-fPIC", "-w", "-fvisibility=default", f'-DROS_PACKAGE_NAME="{package}"', *include]

    def sources(name: str, pattern: str) -> list[Path]:
        return sorted((work / name / package).rglob(pattern))

    functions = [path for path in sources("rosidl_generator_c", "*.c") if not path.name.endswith("__description.c")]
    conversions = [
        path for path in sources("rosidl_generator_py", "*.c") if path.parent != work / "rosidl_generator_py" / package
    ]
    entry = next((work / "rosidl_generator_py" / package).glob("_*.ep.*.c"))
    # Files with the same headers are compiled together. C++ comes first, because it takes longest.
    main = [
        _unit(work, "types.cpp", sources(FAST, "*.cpp") + sources("rosidl_typesupport_c", "*.cpp")),
        _unit(work, "python.c", [*conversions, entry]),
        _unit(work, "functions.c", functions),
        # Each names the types below it with the same static words.
        *sources("rosidl_generator_c", "*__description.c"),
    ]
    introspection = _unit(work, "introspection.c", sources(INTROSPECTION, "*.c"))
    objects = {path: str(work / f"{number}.o") for number, path in enumerate([*main, introspection])}
    with ThreadPoolExecutor(min(3, (os.cpu_count() or 1) + 1)) as pool:
        list(pool.map(_run, [_compilation(path, target, flags) for path, target in objects.items()]))
    folder = prefix / "lib"
    below = [f"-l{name}__{kind}" for name in dependencies for kind in _LIBRARIES if _library(prefixes, name, kind)]
    paths = [part for root in prefixes for part in (f"-L{root / 'lib'}", f"-Wl,-rpath,{root / 'lib'}")]
    common = [f"-L{folder}", *paths, "-Wl,-rpath,$ORIGIN:$ORIGIN/../../..", "-Wl,--as-needed", *below]
    common += [f"-l{INTROSPECTION}", "-lrosidl_typesupport_c", "-lrosidl_runtime_c", "-lrcutils"]
    fast, inner = (folder / f"lib{package}__{name}.so" for name in (FAST, INTROSPECTION))
    # Introspection needs functions of the main library, which is loaded first and brings it along.
    _link(inner, [objects[introspection]], common)
    own = [f"-l{FAST}", "-lrosidl_typesupport_fastrtps_cpp", "-lfastcdr", "-Wl,--no-as-needed", str(inner)]
    _link(fast, [objects[path] for path in main], [*common, *own])
    name = f"{package}_s__rosidl_typesupport_c{sysconfig.get_config_var('EXT_SUFFIX')}"
    extension = site_packages(prefix) / package / name
    extension.symlink_to(os.path.relpath(fast, extension.parent))


def _library(prefixes: tuple[Path, ...], package: str, kind: str) -> bool:
    return any((root / "lib" / f"lib{package}__{kind}.so").is_file() for root in prefixes)


def _unit(work: Path, name: str, sources: list[Path]) -> Path:
    unit = work / name
    unit.write_text("".join(f'#include "{path}"\n' for path in sources))
    return unit


def _compilation(source: Path, target: str, flags: list[str]) -> list[str]:
    # C++14 is the least that Fast CDR takes, and its standard headers are the shortest. GNU's has no trigraphs.
    compiler = ["g++", "-std=gnu++14"] if source.suffix == ".cpp" else ["gcc", "-std=gnu11"]
    return [*compiler, "-c", *flags, str(source), "-o", target]


def _link(target: Path, objects: list[str], libraries: list[str]) -> None:
    _run(["g++", "-shared", f"-Wl,-soname,{target.name}", "-o", str(target), *objects, *libraries])


def _run(command: list[str]) -> None:
    if subprocess.run(command, stdin=subprocess.DEVNULL).returncode != 0:
        raise RuntimeError(f"{command[0]} refused {command[-1]}")
