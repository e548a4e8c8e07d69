from glob import glob
import os

from setuptools import find_packages, setup

NAME = 'robot_navigation_tutorial'
SHARE = os.path.join('share', NAME)
PROGRAMS = ('sensor_processor', 'navigation_controller', 'status_monitor')

setup(
    name=NAME,
    version='0.1.0',
    license='Apache-2.0',
    description='Three nodes that drive a robot by its lidar.',
    maintainer='Ada Student',
    maintainer_email='ada@example.org',
    packages=find_packages(exclude=['test', 'test.*']),
    install_requires=['setuptools'],
    extras_require={'test': ['pytest']},
    zip_safe=True,
    data_files=[
        ('share/ament_index/resource_index/packages', [os.path.join('resource', NAME)]),
        (SHARE, ['package.xml']),
        (os.path.join(SHARE, 'launch'), sorted(glob(os.path.join('launch', '*.launch.py')))),
        (os.path.join(SHARE, 'config'), sorted(glob(os.path.join('config', '*.yaml')))),
    ],
    entry_points={
        'console_scripts': [f'{program} = {NAME}.{program}:main' for program in PROGRAMS],
    },
)
