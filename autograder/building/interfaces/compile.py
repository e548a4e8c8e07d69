"""Compiles generated interface code with the system's gcc, in few translation units and without optimisation."""

from __future__ import annotations

import os
import subprocess
import sysconfig
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy

from autograder.ros.environment import site_packages

FASTRTPS = "rosidl_typesupport_fastrtps_c"
INTROSPECTION = "rosidl_typesupport_introspection_c"
# The libraries to which dependants link. Installed packages have all of them, packages built here only the first two.
_LIBRARIES = (FASTRTPS, INTROSPECTION, "rosidl_generator_c", "rosidl_typesupport_c", "rosidl_generator_py")


def compile_package(
    package: str, prefix: Path, work: Path, prefixes: tuple[Path, ...], dependencies: tuple[str, ...]
) -> None:
    """Compile the generators' output in `work` into libraries and the extension module under `prefix`.

    rcl loads two libraries by name: one for the Fast DDS type support, and one for introspection. The first contains
    everything except introspection, and the extension module is a link to it.

    Args:
        package: the package's name.
        prefix: the folder to which the libraries are written.
        work: the folder with the generated code.
        prefixes: the prefixes of other packages.
        dependencies: all direct and indirect dependencies that are interface packages.
    """
    names = ("rosidl_generator_c", "rosidl_typesupport_c", FASTRTPS, INTROSPECTION)
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
    # Files with the same headers are compiled together. C++ is first, because it takes longest.
    main_units = [
        _unit(work, "types.cpp", sources(FASTRTPS, "*.cpp") + sources("rosidl_typesupport_c", "*.cpp")),
        _unit(work, "python.c", [*conversions, entry]),
        _unit(work, "functions.c", functions),
        # Compiled separately, because they define the same static names for the types that they contain.
        *sources("rosidl_generator_c", "*__description.c"),
    ]
    introspection = _unit(work, "introspection.c", sources(INTROSPECTION, "*.c"))
    objects = {path: str(work / f"{number}.o") for number, path in enumerate([*main_units, introspection])}
    with ThreadPoolExecutor(min(3, (os.cpu_count() or 1) + 1)) as pool:
        list(pool.map(_run, [_compilation(path, target, flags) for path, target in objects.items()]))
    folder = prefix / "lib"
    linked = [f"-l{name}__{kind}" for name in dependencies for kind in _LIBRARIES if _has_library(prefixes, name, kind)]
    paths = [part for root in prefixes for part in (f"-L{root / 'lib'}", f"-Wl,-rpath,{root / 'lib'}")]
    common = [f"-L{folder}", *paths, "-Wl,-rpath,$ORIGIN:$ORIGIN/../../..", "-Wl,--as-needed", *linked]
    common += [f"-l{INTROSPECTION}", "-lrosidl_typesupport_c", "-lrosidl_runtime_c", "-lrcutils"]
    main_library, introspection_library = (folder / f"lib{package}__{name}.so" for name in (FASTRTPS, INTROSPECTION))
    # Introspection needs functions of the main library, which is loaded first and loads introspection.
    _link(introspection_library, [objects[introspection]], common)
    options = [
        f"-l{FASTRTPS}",
        "-lrosidl_typesupport_fastrtps_cpp",
        "-lfastcdr",
        "-Wl,--no-as-needed",
        str(introspection_library),
    ]
    _link(main_library, [objects[path] for path in main_units], [*common, *options])
    name = f"{package}_s__rosidl_typesupport_c{sysconfig.get_config_var('EXT_SUFFIX')}"
    extension = site_packages(prefix) / package / name
    extension.symlink_to(os.path.relpath(main_library, extension.parent))


def _has_library(prefixes: tuple[Path, ...], package: str, kind: str) -> bool:
    return any((root / "lib" / f"lib{package}__{kind}.so").is_file() for root in prefixes)


def _unit(work: Path, name: str, sources: list[Path]) -> Path:
    unit = work / name
    unit.write_text("".join(f'#include "{path}"\n' for path in sources))
    return unit


def _compilation(source: Path, target: str, flags: list[str]) -> list[str]:
    # C++14 is the oldest version that Fast CDR accepts, and has the shortest standard headers. GNU's variant of it has
    # no trigraphs.
    compiler = ["g++", "-std=gnu++14"] if source.suffix == ".cpp" else ["gcc", "-std=gnu11"]
    return [*compiler, "-c", *flags, str(source), "-o", target]


def _link(target: Path, objects: list[str], libraries: list[str]) -> None:
    _run(["g++", "-shared", f"-Wl,-soname,{target.name}", "-o", str(target), *objects, *libraries])


def _run(command: list[str]) -> None:
    if subprocess.run(command, stdin=subprocess.DEVNULL).returncode != 0:
        raise RuntimeError(f"{command[0]} failed on {command[-1]}")
