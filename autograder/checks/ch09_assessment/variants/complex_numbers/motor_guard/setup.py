import os
from glob import glob

from setuptools import find_packages, setup

package_name = 'motor_guard'
setup(
    name=package_name, version='0.1.0', license='Apache-2.0',
    author='Bob Stranger', author_email='bob@example.org',
    maintainer='Bob Stranger', maintainer_email='bob@example.org',
    description='Three nodes that keep a motor cool',
    packages=find_packages(exclude=('test', 'test.*')),
    data_files=[
        (os.path.join('share', 'ament_index', 'resource_index', 'packages'),
         [os.path.join('resource', package_name)]),
        (os.path.join('share', package_name), ['package.xml']),
        (os.path.join('share', package_name, 'launch'), glob('launch/*')),
    ],
    install_requires=['setuptools'], extras_require={'test': ['pytest', 'pytest-timeout']},
    zip_safe=False,
    entry_points={'console_scripts': [
        'thermometer=motor_guard.thermometer:main',
        'smoother=motor_guard.smoother:main',
        'guard=motor_guard.guard:main',
    ]},
)
