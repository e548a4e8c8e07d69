from glob import glob

from setuptools import find_packages, setup

package_name = 'my_robot_package'

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
    description='Nodes of a small robot: one drives by its lidar, one reports its state',
    license='Apache-2.0',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [
            'basic_node = my_robot_package.nodes.basic_node:main',
            'configured_node = my_robot_package.nodes.configured_node:main',
            'distance_driver = my_robot_package.nodes.distance_driver:main',
            'robot_controller = my_robot_package.nodes.robot_controller:main',
            'robust_node = my_robot_package.nodes.robust_node:main',
            'sensor_processor = my_robot_package.nodes.sensor_processor:main',
            'status_publisher = my_robot_package.nodes.status_publisher:main',
        ],
    },
)
