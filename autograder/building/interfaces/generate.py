"""Runs rosidl's generators in one process, and then the compiler.

    python -m autograder.building.interfaces.generate PREFIX

The folder PREFIX contains the `recipe.json` that `prefix.build` wrote. The built package is installed there. All this
runs in a separate process, because the generators are patched, print and keep state, and because it forks, which a
process that uses rclpy must not do.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

from autograder.building.interfaces.compile import compile_package
from autograder.ros.environment import site_packages
from autograder.submission.packages import read_package

C_SUPPORTS = ("rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c")


@dataclass(frozen=True)
class InterfaceBuildJob:
    """A package to build."""

    package: str
    prefix: Path  # the folder in which it is installed
    work: Path  # a folder for generated code
    files: tuple[str, ...]  # the paths of the interfaces' .idl files
    prefixes: tuple[Path, ...]  # the prefixes of other packages, in the order in which they are searched
    dependencies: tuple[str, ...]  # all direct and indirect dependencies that are interface packages

    def share(self, package: str) -> Path:
        """Return the share folder of another package."""
        return next(p / "share" / package for p in self.prefixes if (p / "share" / package).is_dir())

    def output_folder(self, generator: str) -> Path:
        """Return the folder to which a generator writes."""
        return self.work / generator / self.package


def closure(prefixes: tuple[Path, ...], packages: list[str]) -> tuple[str, ...]:
    """Return the interface packages among these packages and all the dependencies that their manifests declare."""
    names: set[str] = set()
    pending = list(packages)
    while pending:
        name = pending.pop()
        share = next((p / "share" / name for p in prefixes if (p / "share" / name / "package.xml").is_file()), None)
        if name in names or share is None or not any((share / kind).is_dir() for kind in ("msg", "srv", "action")):
            continue
        names.add(name)
        pending += read_package(share / "package.xml").depends
    return tuple(sorted(names))


def write_definitions(prefix: Path, package: str, texts: dict[str, str]) -> tuple[str, ...]:
    """Write definitions and their .idl files to the package's share folder. Return the paths of the .idl files.

    `texts` contains the definitions by path.
    """
    from rosidl_adapter.action import convert_action_to_idl
    from rosidl_adapter.msg import convert_msg_to_idl
    from rosidl_adapter.srv import convert_srv_to_idl

    convert = {"msg": convert_msg_to_idl, "srv": convert_srv_to_idl, "action": convert_action_to_idl}
    share = prefix / "share" / package
    for path, text in texts.items():
        kind = path.split("/")[0]
        (share / kind).mkdir(parents=True, exist_ok=True)
        (share / path).write_text(text)
        convert[kind](share, package, Path(path), share / kind)
    return tuple(path.rpartition(".")[0] + ".idl" for path in texts)


def escape_texts() -> None:
    """Make the generators escape each character of a string, except ASCII letters and digits.

    Then no string can end its literal early, no matter how a compiler treats quotation marks, trigraphs or line ends.
    """
    c, python = import_module("rosidl_generator_c"), import_module("rosidl_generator_py.generate_py_impl")

    def escape_bytes(text: str, byte_format: str) -> str:
        return "".join(
            chr(byte) if chr(byte).isalnum() and byte < 128 else byte_format % byte for byte in text.encode()
        )

    c.escape_string = c.escape_wstring = lambda text: escape_bytes(text, "\\%03o")  # type: ignore[attr-defined]
    python.quoted_string = lambda text: f"'{escape_bytes(text, chr(92) + 'x%02x')}'"  # type: ignore[attr-defined]


def parse_once(job: InterfaceBuildJob) -> None:
    """Parse each .idl file once, and cache the result for all generators."""
    parser = import_module("rosidl_parser.parser")
    locator_of = import_module("rosidl_parser.definition").IdlLocator
    parser.parse_idl_string = cache(parser.parse_idl_string)  # type: ignore[attr-defined]
    for file in job.files:
        parser.parse_idl_file(locator_of(job.prefix / "share" / job.package, file))


def write_arguments(job: InterfaceBuildJob, generator: str, **more: Any) -> str:
    """Write the file with a generator's arguments, including `more`. Return its path."""
    output_folder = job.output_folder(generator)
    for kind in {Path(file).parts[0] for file in job.files}:
        (output_folder / kind / "detail" / "dds_fastrtps").mkdir(parents=True, exist_ok=True)
    dependencies = [f"{name}:{idl}" for name in job.dependencies for idl in sorted(job.share(name).rglob("*.idl"))]
    values = {
        "package_name": job.package,
        "output_dir": str(output_folder),
        "template_dir": str(job.share(generator) / "resource"),
        "idl_tuples": [f"{job.prefix / 'share' / job.package}:{file}" for file in job.files],
        "ros_interface_files": [],
        "ros_interface_dependencies": dependencies,
        "target_dependencies": [],
        **more,
    }
    path = job.work / f"{generator}.json"
    path.write_text(json.dumps(values))
    return str(path)


def generate(job: InterfaceBuildJob) -> None:
    """Run all generators: in this process those that need the hashes of types, and the others in a fork."""
    python = import_module("rosidl_generator_py.generate_py_impl")
    descriptions = import_module("rosidl_generator_type_description")
    c, type_support = import_module("rosidl_generator_c"), import_module("rosidl_typesupport_c")
    fastrtps, introspection = map(import_module, C_SUPPORTS)

    def generate_with_type_hashes() -> None:
        include = [f"{name}:{job.share(name)}" for name in job.dependencies]
        descriptions.generate_type_hash(
            write_arguments(job, "rosidl_generator_type_description", include_paths=include)
        )
        descriptions_folder = job.output_folder("rosidl_generator_type_description")
        tuples = [f"{file}:{descriptions_folder / file[:-4]}.json" for file in job.files]
        c.generate_c(write_arguments(job, "rosidl_generator_c", type_description_tuples=tuples))
        introspection.generate_c(write_arguments(job, "rosidl_typesupport_introspection_c"))

    def generate_without_type_hashes() -> None:
        python.generate_py(write_arguments(job, "rosidl_generator_py"), ["rosidl_typesupport_c"])
        type_support.generate_c(write_arguments(job, "rosidl_typesupport_c"), C_SUPPORTS)
        fastrtps.generate_typesupport_fastrtps_c(write_arguments(job, "rosidl_typesupport_fastrtps_c"))

    run_in_parallel(generate_with_type_hashes, generate_without_type_hashes)
    for name in ("rosidl_generator_c", "rosidl_typesupport_c", *C_SUPPORTS):
        template = job.share(name) / "resource" / f"{name}__visibility_control.h.in"
        if template.is_file():
            text = template.read_text().replace("@PROJECT_NAME@", job.package)
            target = job.output_folder(name) / "msg" / template.name.removesuffix(".in")
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text.replace("@PROJECT_NAME_UPPER@", job.package.upper()))


def run_in_parallel(first: Callable[[], None], second: Callable[[], None]) -> None:
    """Run two functions at the same time, the second in a fork."""
    sys.stdout.flush()
    child = os.fork()
    if child == 0:
        status = 1
        try:
            second()
            status = 0
        finally:
            sys.stderr.flush()
            os._exit(status)
    try:
        first()
    finally:
        _, status = os.waitpid(child, 0)
    if status != 0:
        raise RuntimeError("a generator failed")


def install(job: InterfaceBuildJob) -> None:
    """Install the files that dependants need: Python modules, headers, type descriptions, manifest and index."""
    package, share = job.package, job.prefix / "share"
    site = site_packages(job.prefix) / package
    site.mkdir(parents=True)
    (site / "__init__.py").touch()
    for source, target, pattern in (
        (job.output_folder("rosidl_generator_py"), site, "*.py"),
        (job.output_folder("rosidl_generator_type_description"), share / package, "*.json"),
        *(
            (job.output_folder(name), job.prefix / "include" / package / package, "*.h")
            for name in ("rosidl_generator_c", *C_SUPPORTS)
        ),
    ):
        for path in source.rglob(pattern):
            copy = target / path.relative_to(source)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, copy)
    depends = "".join(f"<depend>{escape(name)}</depend>" for name in job.dependencies)
    (share / package / "package.xml").write_text(f'<package format="3"><name>{package}</name>{depends}</package>\n')
    for resource, content in (("packages", ""), ("rosidl_interfaces", "\n".join(job.files))):
        folder = share / "ament_index" / "resource_index" / resource
        folder.mkdir(parents=True)
        (folder / package).write_text(content)


def main() -> None:
    """Build the package that the recipe in PREFIX describes."""
    prefix = Path(sys.argv[1]).resolve()
    recipe = json.loads((prefix / "recipe.json").read_text())
    sys.stdout = Path(os.devnull).open("w")  # the generators print a line for each file  # noqa: SIM115
    work = prefix / "work"
    work.mkdir()
    prefixes = tuple(Path(path) for path in recipe["prefixes"])
    files = write_definitions(prefix, recipe["package"], recipe["texts"])
    job = InterfaceBuildJob(recipe["package"], prefix, work, files, prefixes, closure(prefixes, recipe["uses"]))
    escape_texts()
    parse_once(job)
    generate(job)
    install(job)
    compile_package(job.package, prefix, work, prefixes, job.dependencies)
    shutil.rmtree(work)


if __name__ == "__main__":
    main()
