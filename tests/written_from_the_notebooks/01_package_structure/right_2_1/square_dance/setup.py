"""Install square_dance; the facts that package.xml holds, too, are taken from there."""

from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

manifest = ElementTree.parse('package.xml').getroot()
name = manifest.findtext('name')
maintainer = manifest.find('maintainer')
share = Path('share')


def files(folder, pattern):
    """Return a pair for data_files: where a folder's files go, and which they are."""
    return str(share / name / folder), sorted(map(str, Path(folder).glob(pattern)))


setup(
    name=name,
    version=manifest.findtext('version'),
    description=' '.join(manifest.findtext('description').split()),
    license=manifest.findtext('license'),
    maintainer=maintainer.text,
    maintainer_email=maintainer.get('email'),
    packages=find_packages(include=[name, f'{name}.*']),
    data_files=[
        (str(share / 'ament_index/resource_index/packages'), [f'resource/{name}']),
        (str(share / name), ['package.xml']),
        files('launch', '*.launch.py'),
        files('config', '*.yaml'),
    ],
    entry_points={'console_scripts': [f'dancer = {name}.nodes.dancer:main']},
    install_requires=['setuptools'],
    extras_require={'test': ['pytest>=7.0']},
    zip_safe=True,
)
