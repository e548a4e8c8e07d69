from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

here = Path(__file__).parent
manifest = ElementTree.parse(here / 'package.xml').getroot()  # says it once, for both
name = manifest.findtext('name')


def install(folder, pattern):
    """Return where the files of a folder go, and which these are."""
    files = sorted(here.joinpath(folder).glob(pattern))
    return f'share/{name}/{folder}', [f'{folder}/{file.name}' for file in files]


setup(
    name=name,
    version=manifest.findtext('version'),
    description=manifest.findtext('description'),
    maintainer=manifest.findtext('maintainer'),
    maintainer_email=manifest.find('maintainer').get('email'),
    license=manifest.findtext('license'),
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{name}']),
        (f'share/{name}', ['package.xml']),
        install('launch', '*.launch.py'),
        install('config', '*.yaml'),
    ],
    install_requires=['setuptools'],
    extras_require={'test': ['pytest']},
    zip_safe=True,
    entry_points="""
        [console_scripts]
        sensor_processor = robot_navigation_tutorial.sensor_processor:main
        navigation_controller = robot_navigation_tutorial.navigation_controller:main
        status_monitor = robot_navigation_tutorial.status_monitor:main
    """,
)
