"""A CMake overlay that lets interface packages build without their C++ half, which no Python node loads.

It stands before ROS in CMAKE_PREFIX_PATH and holds a Config file for each C++ generator: that file reads the real one,
then takes the generator out of `rosidl_generate_interfaces`. A package's CMakeLists.txt stays as it is.
"""

from __future__ import annotations

from pathlib import Path

GENERATORS = (
    "rosidl_generator_cpp",
    "rosidl_typesupport_cpp",
    "rosidl_typesupport_fastrtps_cpp",
    "rosidl_typesupport_introspection_cpp",
)
_CONFIG = """set({name}_DIR "{real}")
include("{real}/{name}Config.cmake")
list(FILTER AMENT_EXTENSIONS_rosidl_generate_idl_interfaces EXCLUDE REGEX "^{name}:")
"""


def slim_interfaces(prefixes: tuple[Path, ...], overlay: Path) -> Path:
    """Write the overlay for the ROS in `prefixes` to the folder `overlay`; return it."""
    for name in GENERATORS:
        reals = [folder for prefix in prefixes if (folder := prefix / "share" / name / "cmake").is_dir()]
        if reals:
            folder = overlay / "share" / name / "cmake"
            folder.mkdir(parents=True, exist_ok=True)
            (folder / f"{name}Config.cmake").write_text(_CONFIG.format(name=name, real=reals[0]))
    return overlay
