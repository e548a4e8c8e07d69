from glob import glob
from xml.etree import ElementTree

from setuptools import find_packages, setup

package_name = 'robot_navigation_tutorial'
manifest = ElementTree.parse('package.xml').getroot()
share = f'share/{package_name}'
nodes = 'sensor_processor navigation_controller status_monitor'.split()

setup(
    name=manifest.findtext('name'),
    version=manifest.findtext('version'),
    description=manifest.findtext('description'),
    maintainer=manifest.findtext('maintainer'),
    maintainer_email=manifest.find('maintainer').get('email'),
    license=manifest.findtext('license'),
    packages=find_packages(exclude=['test', 'test.*']),
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{package_name}']),
        (share, ['package.xml']),
        *((f'{share}/{folder}', sorted(glob(f'{folder}/{pattern}')))
          for folder, pattern in (('launch', '*.launch.py'), ('config', '*.yaml'))),
    ],
    install_requires=['setuptools'],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    entry_points={'console_scripts': [f'{node} = {package_name}.{node}:main' for node in nodes]},
)
