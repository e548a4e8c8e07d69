from glob import glob

from setuptools import find_packages, setup

package_name = 'my_robot_package'

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/launch', glob('launch/*.py')),
        ('share/' + package_name + '/config', glob('config/*.yaml')),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='User Name',
    maintainer_email='user@example.com',
    description='Package for my robot functionality',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'sensor_processor = my_robot_package.nodes.sensor_processor:main',
            'robot_controller = my_robot_package.nodes.robot_controller:main',
        ],
    },
)
