"""Templates for the files of a new package. This module does not write files.

The fields and their meanings are those of Jazzy's `ros2 pkg create`, but the wording differs.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

LICENCES = Path(__file__).parent / "licences"

# The identifiers of Jazzy's `ros2 pkg create`, in its order. BSD-2.0 is its older name for the three-clause licence.
LICENCE_TEXTS = {
    "Apache-2.0": "Apache-2.0",
    "BSL-1.0": "BSL-1.0",
    "BSD-2.0": "BSD-3-Clause",
    "BSD-2-Clause": "BSD-2-Clause",
    "BSD-3-Clause": "BSD-3-Clause",
    "GPL-3.0-only": "GPL-3.0-only",
    "LGPL-3.0-only": "LGPL-3.0-only",
    "MIT": "MIT",
    "MIT-0": "MIT-0",
}


@dataclass(frozen=True)
class PackageSpec:
    """The options for a new package.

    Attributes:
        name: the package's name.
        build_type: `ament_python` or `ament_cmake`.
        package_format: the format of package.xml, 2 or 3.
        description, licence: entries of package.xml and setup.py.
        maintainer_name, maintainer_email: entries of package.xml and setup.py.
        dependencies: the names of the packages on which it depends.
        node_name: the executable to create, or `None`; only for `ament_python`.
        library_name: the library to create, or `None`; only for `ament_python`.
    """

    name: str
    build_type: str
    package_format: int
    description: str
    licence: str
    maintainer_name: str
    maintainer_email: str
    dependencies: tuple[str, ...] = ()
    node_name: str | None = None
    library_name: str | None = None


def licence_text(identifier: str, holder: str, year: int) -> str | None:
    """Return the text of the LICENSE file, or `None` for an unknown licence."""
    file = LICENCE_TEXTS.get(identifier)
    if file is None:
        return None
    text = (LICENCES / f"{file}.txt").read_text(encoding="utf-8")
    return text.replace("{copyright}", f"Copyright (c) {year} {holder}")


def package_xml(spec: PackageSpec) -> str:
    """Return the manifest, package.xml."""
    if spec.build_type == "ament_python":
        tools, tests = [], ["ament_copyright", "ament_flake8", "ament_pep257", "python3-pytest"]
    else:
        tools, tests = ["ament_cmake"], ["ament_lint_auto", "ament_lint_common"]
    groups = (("buildtool_depend", tools), ("depend", spec.dependencies), ("test_depend", tests))
    blocks = ["\n".join(f"  <{tag}>{escape(name)}</{tag}>" for name in names) for tag, names in groups if names]
    schema = f"http://download.ros.org/schema/package_format{spec.package_format}.xsd"
    maintainer = f"<maintainer email={quoteattr(spec.maintainer_email)}>{escape(spec.maintainer_name)}</maintainer>"
    return f"""<?xml version="1.0"?>
<?xml-model href="{schema}" schematypens="http://www.w3.org/2001/XMLSchema"?>
<package format="{spec.package_format}">
  <name>{spec.name}</name>
  <version>0.0.0</version>
  <description>{escape(spec.description)}</description>
  {maintainer}
  <license>{escape(spec.licence)}</license>

{"".join(f"{block}{chr(10) * 2}" for block in blocks)}  <export>
    <build_type>{spec.build_type}</build_type>
  </export>
</package>
"""


def setup_py(spec: PackageSpec) -> str:
    """Return setup.py of an ament_python package."""
    script = f"            '{spec.node_name} = {spec.name}.{spec.node_name}:main',\n" if spec.node_name else ""
    return f"""from setuptools import find_packages, setup

package_name = '{spec.name}'

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer={_quote(spec.maintainer_name)},
    maintainer_email={_quote(spec.maintainer_email)},
    description={_quote(spec.description)},
    license={_quote(spec.licence)},
    tests_require=['pytest'],
    entry_points={{
        'console_scripts': [
{script}        ],
    }},
)
"""


def setup_cfg(spec: PackageSpec) -> str:
    """Return setup.cfg of an ament_python package, which installs executables where `ros2 run` looks for them."""
    return f"""[develop]
script_dir=$base/lib/{spec.name}
[install]
install_scripts=$base/lib/{spec.name}
"""


def python_node(spec: PackageSpec) -> str:
    """Return the module of an ament_python package's executable."""
    return f"""def main():
    print('Hi from {spec.name}.')


if __name__ == '__main__':
    main()
"""


def cmakelists(spec: PackageSpec) -> str:
    """Return CMakeLists.txt of an ament_cmake package without C++ targets."""
    finds = "\n".join(f"find_package({name} REQUIRED)" for name in ["ament_cmake", *spec.dependencies])
    return f"""cmake_minimum_required(VERSION 3.8)
project({spec.name})

if(CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  add_compile_options(-Wall -Wextra -Wpedantic)
endif()

{finds}

if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  # Take the next two lines away once every source file has a copyright header and the package is in git.
  set(ament_cmake_copyright_FOUND TRUE)
  set(ament_cmake_cpplint_FOUND TRUE)
  ament_lint_auto_find_test_dependencies()
endif()

ament_package()
"""


PYTHON_TESTS = {
    "test_copyright.py": """from ament_copyright.main import main
import pytest


# Take this mark away once each source file begins with a copyright notice and a licence.
@pytest.mark.skip(reason='The generated source files carry no copyright header yet.')
@pytest.mark.copyright
@pytest.mark.linter
def test_copyright():
    assert main(argv=['.', 'test']) == 0, 'ament_copyright found errors'
""",
    "test_flake8.py": """from ament_flake8.main import main_with_errors
import pytest


@pytest.mark.flake8
@pytest.mark.linter
def test_flake8():
    exit_code, errors = main_with_errors(argv=[])
    assert exit_code == 0, f'{len(errors)} code style errors:\\n' + '\\n'.join(errors)
""",
    "test_pep257.py": """from ament_pep257.main import main
import pytest


@pytest.mark.linter
@pytest.mark.pep257
def test_pep257():
    assert main(argv=['.', 'test']) == 0, 'ament_pep257 found docstring errors'
""",
}


def _quote(text: str) -> str:
    """Return a Python string literal in single quotes, as ROS's style requires."""
    literal = repr(text)
    return literal if literal[0] == "'" else "'" + literal[1:-1].replace("'", "\\'") + "'"
