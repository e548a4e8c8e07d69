import glob
import os

import setuptools

NAME = 'square_dance'

data_files = [
    ('share/ament_index/resource_index/packages', [os.path.join('resource', NAME)]),
    (f'share/{NAME}', ['package.xml']),
]
for folder, ending in (('launch', '.launch.py'), ('config', '.yaml')):
    data_files.append((f'share/{NAME}/{folder}', glob.glob(f'{folder}/*{ending}')))

metadata = {
    'version': '0.0.1',
    'author': 'Student Two',
    'author_email': 's2@students.example.edu',
    'maintainer': 'Student Two',
    'maintainer_email': 's2@students.example.edu',
    'description': 'Drives one square',
    'license': 'Apache-2.0',
}

setuptools.setup(
    name=NAME,
    packages=setuptools.find_packages(where='.', exclude=('test', 'test.*')),
    data_files=data_files,
    install_requires=['setuptools'],
    extras_require=dict(test=['pytest']),
    zip_safe=False,
    entry_points="""
        [console_scripts]
        dancer = square_dance.nodes.dancer:main
    """,
    **metadata,
)
