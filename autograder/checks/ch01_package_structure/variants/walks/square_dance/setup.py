import os

import setuptools

name = 'square_dance'
packages = [
    folder.replace(os.sep, '.') for folder, _, names in os.walk(name) if '__init__.py' in names
]
data_files = [
    (os.path.join('share', 'ament_index', 'resource_index', 'packages'),
     [os.path.join('resource', name)]),
    (os.path.join('share', name), ['package.xml']),
]
for folder, ending in (('launch', '.launch.py'), ('config', '.yaml')):
    paths = [entry.path for entry in os.scandir(folder) if entry.name.endswith(ending)]
    data_files.append((os.path.join('share', name, folder), paths))

setuptools.setup(
    name=name,
    version='0.1.0',
    packages=packages,
    data_files=data_files,
    zip_safe=True,
    maintainer='Robot Course',
    maintainer_email='robot.course@example.com',
    description='A package whose set-up walks through its folders',
    license='Apache-2.0',
    extras_require={'test': ['pytest', 'pytest-cov']},
    entry_points={'console_scripts': ['dancer = square_dance.nodes.dancer:main']},
)
