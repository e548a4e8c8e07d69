from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

manifest = ElementTree.parse(Path(__file__).resolve().with_name('package.xml')).getroot()
name = manifest.findtext('name')
maintainer = manifest.find('maintainer')
share = Path('share')

setup(
    name=name,
    version=manifest.findtext('version'),
    description=manifest.findtext('description'),
    license=manifest.findtext('license'),
    maintainer=maintainer.text,
    maintainer_email=maintainer.get('email'),
    packages=find_packages(include=[name, f'{name}.*']),
    data_files=[
        (str(share / 'ament_index' / 'resource_index' / 'packages'), [f'resource/{name}']),
        (str(share / name), ['package.xml']),
        (str(share / name / 'launch'), [str(path) for path in Path('launch').glob('*.launch.py')]),
    ],
    install_requires=['setuptools'],
    extras_require={'test': ['pytest']},
    zip_safe=True,
    entry_points={'console_scripts': [
        f'{node} = {name}.{node}:main' for node in ('guard', 'smoother', 'thermometer')]},
)
