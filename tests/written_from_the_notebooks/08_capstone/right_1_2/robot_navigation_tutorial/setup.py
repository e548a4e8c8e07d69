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

import os
from pathlib import Path

from setuptools import setup

package_name = 'robot_navigation_tutorial'
share = os.path.join('share', package_name)
nodes = ['sensor_processor', 'navigation_controller', 'status_monitor']


def files(folder, pattern):
    """Return the files of a folder that are installed, and where to."""
    found = sorted(str(path) for path in Path(folder).glob(pattern))
    return os.path.join(share, folder), found


setup(
    name=package_name,
    version='0.1.0',
    packages=[package_name],
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{package_name}']),
        (share, ['package.xml']),
        files('launch', '*.launch.py'),
        files('config', '*.yaml'),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Ada Student',
    maintainer_email='ada.student@example.org',
    description='Three nodes that find their way',
    license='Apache-2.0',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [f'{node} = {package_name}.{node}:main' for node in nodes],
    },
)
