import glob
import os

from setuptools import setup

NAME = 'wall_alarm'
VERSION = '0.1.0'
LICENSE = 'Apache-2.0'
SHARE = os.path.join('share', NAME)


def modules():
    """Find each folder below the module's own in which there is an __init__.py."""
    for file in glob.glob(os.path.join(NAME, '**', '__init__.py'), recursive=True):
        yield os.path.dirname(file).replace(os.sep, '.')


def data_files():
    """Say what goes where below the install folder."""
    yield 'share/ament_index/resource_index/packages', ['resource/' + NAME]
    yield SHARE, ['package.xml']
    for folder, ending in (('launch', '.launch.py'), ('config', '.yaml')):
        yield os.path.join(SHARE, folder), glob.glob(os.path.join(folder, '*' + ending))


setup(
    name=NAME,
    version=VERSION,
    license=LICENSE,
    description='An alarm that goes off when the lidar sees something near',
    maintainer='Robot Course',
    maintainer_email='robot.course@example.com',
    url='https://example.com',
    packages=list(modules()),
    data_files=list(data_files()),
    install_requires=['setuptools'],
    tests_require=['pytest'],
    extras_require={'test': ['pytest'], 'plot': ['matplotlib']},
    entry_points="""
[console_scripts]
alarm = wall_alarm.nodes.alarm:main
""",
)
