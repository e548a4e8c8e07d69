import os
from glob import glob
from setuptools import setup

package_name = 'wall_alarm'

setup(
    name=package_name,
    version='0.1.0',
    packages=[package_name, package_name + '.nodes', package_name + '.utils'],
    data_files=[
        (os.path.join('share', 'ament_index', 'resource_index', 'packages'), [os.path.join('resource', package_name)]),
        (os.path.join('share', package_name), ['package.xml']),
        (os.path.join('share', package_name, 'launch'), ['launch/wall_alarm.launch.py']),
        (os.path.join('share', package_name, 'config'), glob(os.path.join('config', '*.y*ml'))),
    ],
    maintainer='Robot Course',
    maintainer_email='robot.course@example.com',
    license='Apache-2.0',
    extras_require={'tests': ['pytest']},
    entry_points={'console_scripts': ['alarm=wall_alarm.nodes.alarm:main']},
)
