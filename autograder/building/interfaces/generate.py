"""Runs rosidl's real generators in one process, then the compiler.

    python -m autograder.building.interfaces.generate PREFIX

PREFIX contains `recipe.json`, as `build` wrote it, and gets the built package. This is a separate process, because the
generators patch, print and keep state, and because it forks, which a process with a running rclpy must not do.
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

from autograder.building.interfaces import compile as compiling
from autograder.ros.environment import site_packages
from autograder.submission.packages import read_package

C_SUPPORTS = ("rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c")


@dataclass(frozen=True)
class InterfaceBuildJob:
    """A package that is built."""

    package: str
    prefix: Path  # where it goes
    work: Path  # a folder for generated code
    files: tuple[str, ...]  # the interfaces' paths as .idl
    prefixes: tuple[Path, ...]  # where other packages are found, the nearest first
    dependencies: tuple[str, ...]  # all interface packages below this one

    def share(self, package: str) -> Path:
        """Return the share folder of another package."""
        return next(p / "share" / package for p in self.prefixes if (p / "share" / package).is_dir())

    def out(self, generator: str) -> Path:
        """Return where a generator writes."""
        return self.work / generator / self.package


def closure(prefixes: tuple[Path, ...], packages: list[str]) -> tuple[str, ...]:
    """Return the interface packages that these lead to, by their manifests."""
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


def adapt(prefix: Path, package: str, texts: dict[str, str]) -> tuple[str, ...]:
    """Write definitions, texts by path, and their .idl into the share folder; return the .idl paths."""
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
    """Make the generators write each character of a text as an escape, except plain letters and digits.

    So no text can leave its literal, whatever a compiler makes of quotation marks, trigraphs or line ends.
    """
    c, python = import_module("rosidl_generator_c"), import_module("rosidl_generator_py.generate_py_impl")

    def escaped(text: str, code: str) -> str:
        return "".join(chr(byte) if chr(byte).isalnum() and byte < 128 else code % byte for byte in text.encode())

    c.escape_string = c.escape_wstring = lambda text: escaped(text, "\\%03o")  # type: ignore[attr-defined]
    python.quoted_string = lambda text: f"'{escaped(text, chr(92) + 'x%02x')}'"  # type: ignore[attr-defined]


def share_parsing(job: InterfaceBuildJob) -> None:
    """Parse each .idl, and pass the result to the generators."""
    parser = import_module("rosidl_parser.parser")
    locator_of = import_module("rosidl_parser.definition").IdlLocator
    parser.parse_idl_string = cache(parser.parse_idl_string)  # type: ignore[attr-defined]
    for file in job.files:
        parser.parse_idl_file(locator_of(job.prefix / "share" / job.package, file))


def arguments(job: InterfaceBuildJob, generator: str, **more: Any) -> str:
    """Write a generator's arguments file; return its path."""
    out = job.out(generator)
    for kind in {Path(file).parts[0] for file in job.files}:
        (out / kind / "detail" / "dds_fastrtps").mkdir(parents=True, exist_ok=True)
    below = [f"{name}:{idl}" for name in job.dependencies for idl in sorted(job.share(name).rglob("*.idl"))]
    values = {
        "package_name": job.package,
        "output_dir": str(out),
        "template_dir": str(job.share(generator) / "resource"),
        "idl_tuples": [f"{job.prefix / 'share' / job.package}:{file}" for file in job.files],
        "ros_interface_files": [],
        "ros_interface_dependencies": below,
        "target_dependencies": [],
        **more,
    }
    path = job.work / f"{generator}.json"
    path.write_text(json.dumps(values))
    return str(path)


def generate(job: InterfaceBuildJob) -> None:
    """Run all generators in two processes: those that need the type hashes here, the rest in a fork."""
    python = import_module("rosidl_generator_py.generate_py_impl")
    descriptions = import_module("rosidl_generator_type_description")
    code, supports = import_module("rosidl_generator_c"), import_module("rosidl_typesupport_c")
    fast, introspection = map(import_module, C_SUPPORTS)

    def types() -> None:
        include = [f"{name}:{job.share(name)}" for name in job.dependencies]
        descriptions.generate_type_hash(arguments(job, "rosidl_generator_type_description", include_paths=include))
        described = job.out("rosidl_generator_type_description")
        tuples = [f"{file}:{described / file[:-4]}.json" for file in job.files]
        code.generate_c(arguments(job, "rosidl_generator_c", type_description_tuples=tuples))
        introspection.generate_c(arguments(job, "rosidl_typesupport_introspection_c"))

    def rest() -> None:
        python.generate_py(arguments(job, "rosidl_generator_py"), ["rosidl_typesupport_c"])
        supports.generate_c(arguments(job, "rosidl_typesupport_c"), C_SUPPORTS)
        fast.generate_typesupport_fastrtps_c(arguments(job, "rosidl_typesupport_fastrtps_c"))

    both(types, rest)
    for name in ("rosidl_generator_c", "rosidl_typesupport_c", *C_SUPPORTS):
        template = job.share(name) / "resource" / f"{name}__visibility_control.h.in"
        if template.is_file():
            text = template.read_text().replace("@PROJECT_NAME@", job.package)
            target = job.out(name) / "msg" / template.name.removesuffix(".in")
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text.replace("@PROJECT_NAME_UPPER@", job.package.upper()))


def both(here: Callable[[], None], aside: Callable[[], None]) -> None:
    """Run two functions at the same time, the second in a fork."""
    sys.stdout.flush()
    child = os.fork()
    if child == 0:
        status = 1
        try:
            aside()
            status = 0
        finally:
            sys.stderr.flush()
            os._exit(status)
    try:
        here()
    finally:
        _, status = os.waitpid(child, 0)
    if status != 0:
        raise RuntimeError("a generator failed")


def install(job: InterfaceBuildJob) -> None:
    """Install the files that dependants and `load` need: Python, headers, type descriptions, manifest, index."""
    package, share = job.package, job.prefix / "share"
    site = site_packages(job.prefix) / package
    site.mkdir(parents=True)
    (site / "__init__.py").touch()
    for source, target, ending in (
        (job.out("rosidl_generator_py"), site, "*.py"),
        (job.out("rosidl_generator_type_description"), share / package, "*.json"),
        *(
            (job.out(name), job.prefix / "include" / package / package, "*.h")
            for name in ("rosidl_generator_c", *C_SUPPORTS)
        ),
    ):
        for path in source.rglob(ending):
            place = target / path.relative_to(source)
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, place)
    depends = "".join(f"<depend>{escape(name)}</depend>" for name in job.dependencies)
    (share / package / "package.xml").write_text(f'<package format="3"><name>{package}</name>{depends}</package>\n')
    for resource, content in (("packages", ""), ("rosidl_interfaces", "\n".join(job.files))):
        folder = share / "ament_index" / "resource_index" / resource
        folder.mkdir(parents=True)
        (folder / package).write_text(content)


def main() -> None:
    """Build the package of the recipe in PREFIX."""
    prefix = Path(sys.argv[1]).resolve()
    recipe = json.loads((prefix / "recipe.json").read_text())
    sys.stdout = Path(os.devnull).open("w")  # the generators tell of each file  # noqa: SIM115
    work = prefix / "work"
    work.mkdir()
    prefixes = tuple(Path(path) for path in recipe["prefixes"])
    files = adapt(prefix, recipe["package"], recipe["texts"])
    job = InterfaceBuildJob(recipe["package"], prefix, work, files, prefixes, closure(prefixes, recipe["uses"]))
    escape_texts()
    share_parsing(job)
    generate(job)
    install(job)
    compiling.compile_package(job.package, prefix, work, prefixes, job.dependencies)
    shutil.rmtree(work)


if __name__ == "__main__":
    main()
