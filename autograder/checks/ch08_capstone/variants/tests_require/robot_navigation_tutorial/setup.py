from glob import glob

from setuptools import find_packages, setup

package_name = 'robot_navigation_tutorial'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/launch', glob('launch/*.launch.py')),
        ('share/' + package_name + '/config', glob('config/*.yaml')),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Robot Course',
    maintainer_email='robot.course@example.com',
    description='Reactive navigation: from a laser scan to a velocity, watched by a monitor',
    license='Apache-2.0',
    tests_require=['pytest'],
    entry_points={
        'console_scripts': [
            'sensor_processor = robot_navigation_tutorial.sensor_processor:main',
            'navigation_controller = robot_navigation_tutorial.navigation_controller:main',
            'status_monitor = robot_navigation_tutorial.status_monitor:main',
        ],
    },
)
