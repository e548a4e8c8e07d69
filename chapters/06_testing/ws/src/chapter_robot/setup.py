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
    description='The controller and its test as a textbook prints them',
    license='Apache-2.0',
    tests_require=['pytest'],
    entry_points={
        'console_scripts': [
            'robot_controller = chapter_robot.nodes.robot_controller:main',
        ],
    },
)
