from glob import glob
import os

from setuptools import find_packages, setup

package_name = 'wall_alarm'
share = os.path.join('share', package_name)

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(),
    data_files=[
        (os.path.join('share', 'ament_index', 'resource_index', 'packages'),
            [os.path.join('resource', package_name)]),
        (share, ['package.xml']),
        (os.path.join(share, 'launch'), glob(os.path.join('launch', '*.launch.py'))),
        (os.path.join(share, 'config'), glob(os.path.join('config', '*'))),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Robot Course',
    maintainer_email='robot.course@example.com',
    description='An alarm that goes off when the lidar sees something near',
    license='Apache-2.0',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [
            f'alarm = {package_name}.nodes.alarm:main',
        ],
    },
)
