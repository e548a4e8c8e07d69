"""The files of a new ament_cmake package, as text.

The fields and what they mean are those of Jazzy's `ros2 pkg create`; the wording is our own. One thing differs on
purpose: CMakeLists.txt does without the lint packages where they are not installed.
"""

from __future__ import annotations

from autograder.ros.ros2.pkg_templates import PackageSpec


def cmakelists(spec: PackageSpec) -> str:
    """Return CMakeLists.txt of an ament_cmake package."""
    tools = ["ament_cmake", *(["ament_cmake_ros"] if spec.library_name else [])]
    finds = "\n".join(f"find_package({name} REQUIRED)" for name in [*tools, *spec.dependencies])
    parts = [
        f"""cmake_minimum_required(VERSION 3.10)
project({spec.name})

if(CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  add_compile_options(-Wall -Wextra -Wpedantic)
endif()

{finds}
""",
        _cmake_library(spec) if spec.library_name else "",
        _cmake_node(spec) if spec.node_name else "",
        """
if(BUILD_TESTING)
  # Part of a ROS 2 installation; a build without it skips the linters.
  find_package(ament_lint_auto QUIET)
  if(ament_lint_auto_FOUND)
    # Take the next two lines away once every source file has a copyright header and the package is in git.
    set(ament_cmake_copyright_FOUND TRUE)
    set(ament_cmake_cpplint_FOUND TRUE)
    ament_lint_auto_find_test_dependencies()
  endif()
endif()

ament_package()
""",
    ]
    return "".join(parts)


def _cmake_library(spec: PackageSpec) -> str:
    name = spec.library_name
    return f"""
add_library({name} src/{name}.cpp)
add_library({spec.name}::{name} ALIAS {name})
target_compile_features({name} PUBLIC c_std_99 cxx_std_17)
target_include_directories({name} PUBLIC
  $<BUILD_INTERFACE:${{CMAKE_CURRENT_SOURCE_DIR}}/include>
  $<INSTALL_INTERFACE:include/${{PROJECT_NAME}}>)
{_cmake_links(spec, name)}# Makes the header's macros export the symbols here, and import them elsewhere.
target_compile_definitions({name} PRIVATE "{spec.name.upper()}_BUILDING_LIBRARY")

install(DIRECTORY include/ DESTINATION include/${{PROJECT_NAME}})
install(TARGETS {name}
  EXPORT export_${{PROJECT_NAME}}
  ARCHIVE DESTINATION lib
  LIBRARY DESTINATION lib
  RUNTIME DESTINATION bin
)
ament_export_include_directories("include/${{PROJECT_NAME}}")
ament_export_libraries({name})
ament_export_targets(export_${{PROJECT_NAME}})
"""


def _cmake_node(spec: PackageSpec) -> str:
    name = spec.node_name
    link = f"target_link_libraries({name} {spec.library_name})\n" if spec.library_name else _cmake_links(spec, name)
    return f"""
add_executable({name} src/{name}.cpp)
target_include_directories({name} PUBLIC
  $<BUILD_INTERFACE:${{CMAKE_CURRENT_SOURCE_DIR}}/include>
  $<INSTALL_INTERFACE:include/${{PROJECT_NAME}}>)
target_compile_features({name} PUBLIC c_std_99 cxx_std_17)
{link}
install(TARGETS {name}
  DESTINATION lib/${{PROJECT_NAME}})
"""


def _cmake_links(spec: PackageSpec, target: str | None) -> str:
    if not spec.dependencies:
        return ""
    names = "".join(f'\n  "{name}"' for name in spec.dependencies)
    return f"ament_target_dependencies({target}{names}\n)\n"


def cpp_node(spec: PackageSpec) -> str:
    """Return the source of an ament_cmake package's executable."""
    include = f'#include "{spec.name}/{spec.library_name}.hpp"\n' if spec.library_name else ""
    use = f"  {spec.name}::{_camel(spec.library_name)} unused;\n  (void) unused;\n" if spec.library_name else ""
    return f"""#include <cstdio>
{include}
int main(int argc, char ** argv)
{{
  (void) argc;
  (void) argv;

{use}  printf("hello world {spec.name} package\\n");
  return 0;
}}
"""


def cpp_library(spec: PackageSpec) -> dict[str, str]:
    """Return the header, the source and the visibility macros of a library, by path."""
    assert spec.library_name is not None
    name, macro = spec.library_name, spec.name.upper()
    camel = _camel(name)
    guard = f"{macro}__{name.upper()}_HPP_"
    return {
        f"include/{spec.name}/{name}.hpp": f"""#ifndef {guard}
#define {guard}

#include "{spec.name}/visibility_control.h"

namespace {spec.name}
{{

class {camel}
{{
public:
  {macro}_PUBLIC
  {camel}();

  {macro}_PUBLIC
  virtual ~{camel}();
}};

}}  // namespace {spec.name}

#endif  // {guard}
""",
        f"src/{name}.cpp": f"""#include "{spec.name}/{name}.hpp"

namespace {spec.name}
{{

{camel}::{camel}()
{{
}}

{camel}::~{camel}()
{{
}}

}}  // namespace {spec.name}
""",
        f"include/{spec.name}/visibility_control.h": f"""#ifndef {macro}__VISIBILITY_CONTROL_H_
#define {macro}__VISIBILITY_CONTROL_H_

// Which symbols a shared library shows: Windows needs to be told on both sides, others hide what is not PUBLIC.
#if defined _WIN32 || defined __CYGWIN__
  #ifdef {macro}_BUILDING_LIBRARY
    #define {macro}_PUBLIC __declspec(dllexport)
  #else
    #define {macro}_PUBLIC __declspec(dllimport)
  #endif
  #define {macro}_LOCAL
#else
  #define {macro}_PUBLIC __attribute__ ((visibility("default")))
  #define {macro}_LOCAL __attribute__ ((visibility("hidden")))
#endif

#endif  // {macro}__VISIBILITY_CONTROL_H_
""",
    }


def _camel(name: str | None) -> str:
    return "".join(part.capitalize() for part in (name or "").split("_"))
