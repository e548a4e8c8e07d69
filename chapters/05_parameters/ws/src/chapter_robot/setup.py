from setuptools import find_packages, setup

package_name = 'chapter_robot'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Robot Course',
    maintainer_email='robot.course@example.com',
    description='Two nodes as a textbook prints them, to be run and broken',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'configured_node = chapter_robot.configured_node:main',
            'robot_controller = chapter_robot.robot_controller:main',
        ],
    },
)
