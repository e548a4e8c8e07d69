from pathlib import Path
from xml.etree import ElementTree

import setuptools

manifest = ElementTree.parse(Path(__file__).resolve().with_name('package.xml')).getroot()
name = manifest.findtext('name')
maintainer = manifest.find('maintainer')
installed = {
    'share/ament_index/resource_index/packages': f'resource/{name}',
    f'share/{name}': 'package.xml',
    f'share/{name}/launch': 'launch/*.launch.py',
    f'share/{name}/config': 'config/*.yaml',
}

setuptools.setup(
    name=name,
    version=manifest.findtext('version'),
    description=manifest.findtext('description'),
    license=manifest.findtext('license'),
    maintainer=maintainer.text,
    maintainer_email=maintainer.attrib['email'],
    packages=setuptools.find_packages(include=[name, name + '.*']),
    data_files=[
        (folder, [str(path) for path in sorted(Path().glob(pattern))])
        for folder, pattern in installed.items()],
    install_requires=['setuptools'],
    extras_require={'test': ['pytest']},
    zip_safe=True,
    entry_points={'console_scripts': ['dancer=square_dance.nodes.dancer:main']},
)
