# Copyright 2026 The ROS 2 Python Course Authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""What the launch files name is there, and what they hand to the nodes fits."""

import ast
from pathlib import Path

import pytest
import yaml

PACKAGE = Path(__file__).parents[1]
LAUNCH_FILES = sorted((PACKAGE / 'launch').glob('*.launch.py'))


def words(path, name):
    """Return the texts that a Python file gives to arguments of this name."""
    return [
        keyword.value.value
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Call)
        for keyword in node.keywords
        if keyword.arg == name and isinstance(keyword.value, ast.Constant)
    ]


def executables():
    """Return the executables that setup.py installs."""
    text = (PACKAGE / 'setup.py').read_text()
    return {line.split("'")[1].split(' = ')[0] for line in text.splitlines() if ':main' in line}


def test_there_are_launch_files():
    """The package holds the three launch files."""
    assert [path.name.split('.')[0] for path in LAUNCH_FILES] == [
        'robot', 'safe_start', 'two_robots']


@pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)
def test_each_launched_executable_is_installed(path):
    """Each executable that a launch file names has an entry point in setup.py."""
    assert set(words(path, 'executable')) <= executables()
    assert set(words(path, 'package')) <= {PACKAGE.name}


def test_each_entry_point_has_its_module():
    """Each executable has a module of its name."""
    assert executables()
    for name in executables():
        assert (PACKAGE / PACKAGE.name / f'{name}.py').is_file()


def test_parameters_stand_under_a_node_that_declares_them():
    """Each name in the parameters file is declared by its node, in the node's own module."""
    config = yaml.safe_load((PACKAGE / 'config' / 'robot.yaml').read_text())
    assert config
    for key, entry in config.items():
        module = PACKAGE / PACKAGE.name / f'{key.rpartition("/")[2]}.py'
        for name in entry['ros__parameters']:
            assert f"self.parameter('{name}'" in module.read_text()
