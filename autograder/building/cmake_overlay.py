"""A CMake overlay that halves the build time of interface packages without changes to their CMakeLists.txt.

It precedes ROS in CMAKE_PREFIX_PATH. For each of rosidl's generators, it contains a Config file that includes the real
one. It changes the steps of a build, but not its messages or the files that are installed for Python nodes:

- `rosidl_generate_interfaces` does not run the C++ generators, which Python nodes do not need.
- Each library of the other generators is compiled as one unit, because common headers take nearly all of the time.
"""

from __future__ import annotations

from pathlib import Path

EXCLUDED = (
    "rosidl_generator_cpp",
    "rosidl_typesupport_cpp",
    "rosidl_typesupport_fastrtps_cpp",
    "rosidl_typesupport_introspection_cpp",
)
COMPILED = (
    "rosidl_generator_c",
    "rosidl_generator_py",
    "rosidl_typesupport_c",
    "rosidl_typesupport_fastrtps_c",
    "rosidl_typesupport_introspection_c",
)
_CONFIG = 'set({name}_DIR "{real}")\ninclude("{real}/{name}Config.cmake")\n'
_EXCLUDE = 'list(FILTER AMENT_EXTENSIONS_rosidl_generate_idl_interfaces EXCLUDE REGEX "^{name}:")\n'
_EXTEND = """set({name}_together_DIR "{folder}")
ament_register_extension("rosidl_generate_idl_interfaces" "{name}_together" "together.cmake")
"""
# Descriptions are compiled separately, because they define the same static names for the types that they contain.
_TOGETHER = """set(_library "${{rosidl_generate_interfaces_TARGET}}__{name}")
if(TARGET ${{_library}})
  get_target_property(_alone ${{_library}} SOURCES)
  list(FILTER _alone INCLUDE REGEX "__description[.]c$")
  if(_alone)
    set_source_files_properties(${{_alone}} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  set_target_properties(${{_library}} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
endif()
"""


def write_overlay(prefixes: tuple[Path, ...], overlay: Path) -> Path:
    """Write the overlay for the ROS in `prefixes` to the new folder `overlay`; return the folder."""
    for name in (*EXCLUDED, *COMPILED):
        real = next((folder for p in prefixes if (folder := p / "share" / name / "cmake").is_dir()), None)
        if real is None:
            continue
        folder = overlay / "share" / name / "cmake"
        folder.mkdir(parents=True)
        config = _CONFIG.format(name=name, real=real)
        if name in EXCLUDED:
            config += _EXCLUDE.format(name=name)
        else:
            (folder / "together.cmake").write_text(_TOGETHER.format(name=name))
            config += _EXTEND.format(name=name, folder=folder)
        (folder / f"{name}Config.cmake").write_text(config)
    return overlay
