"""A CMake overlay that lets interface packages build faster: without their C++ half, and with generators that remember.

It stands before ROS in CMAKE_PREFIX_PATH and holds a Config file for each generator. That file reads the real one; then
it takes a C++ generator, which no Python node needs, out of `rosidl_generate_interfaces`, and lets `generator_host`
run each of the others. A package's CMakeLists.txt stays as it is.
"""

from __future__ import annotations

from pathlib import Path

HOST = Path(__file__).with_name("generator_host.py")
TEMPLATES = Path(__file__).parents[1] / "interfaces" / "templates.py"  # the host reads it
LEFT_OUT = (
    "rosidl_generator_cpp",
    "rosidl_typesupport_cpp",
    "rosidl_typesupport_fastrtps_cpp",
    "rosidl_typesupport_introspection_cpp",
)
HOSTED = (
    "rosidl_generator_type_description",
    "rosidl_generator_c",
    "rosidl_generator_py",
    "rosidl_typesupport_c",
    "rosidl_typesupport_fastrtps_c",
    "rosidl_typesupport_introspection_c",
)
_CONFIG = 'set({name}_DIR "{real}")\ninclude("{real}/{name}Config.cmake")\n'
_LEAVE_OUT = 'list(FILTER AMENT_EXTENSIONS_rosidl_generate_idl_interfaces EXCLUDE REGEX "^{name}:")\n'
_TAKE = 'set({name}_BIN "{program}")\n'
_PROGRAM = """from pathlib import Path
from runpy import run_path

run_path("{host}")["run"](Path("{generator}"), Path("{parsed}"))
"""


def write_overlay(prefixes: tuple[Path, ...], overlay: Path) -> Path:
    """Write the overlay for the ROS in `prefixes` to the folder `overlay`; return it.

    The folder is the build's own: what the generators remember goes there, too.
    """
    for name in LEFT_OUT:
        _write_config(prefixes, overlay, name, _LEAVE_OUT.format(name=name))
    for name in HOSTED:
        program = overlay / "lib" / name
        found = [path for prefix in prefixes if (path := prefix / "lib" / name / name).is_file()]
        if found and _write_config(prefixes, overlay, name, _TAKE.format(name=name, program=program)):
            program.parent.mkdir(parents=True, exist_ok=True)
            program.write_text(_PROGRAM.format(host=HOST, generator=found[0], parsed=overlay / "parsed"))
    return overlay


def _write_config(prefixes: tuple[Path, ...], overlay: Path, name: str, change: str) -> bool:
    """Write a Config file that reads the real one first; return whether there is a real one."""
    reals = [folder for prefix in prefixes if (folder := prefix / "share" / name / "cmake").is_dir()]
    if reals:
        folder = overlay / "share" / name / "cmake"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{name}Config.cmake").write_text(_CONFIG.format(name=name, real=reals[0]) + change)
    return bool(reals)
