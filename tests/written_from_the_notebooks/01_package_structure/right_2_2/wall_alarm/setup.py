from setuptools import setup

package_name = 'wall_alarm'

setup(
    name=package_name,
    version='0.1.0',
    packages=[package_name, package_name + '.nodes', package_name + '.utils'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/wall_alarm']),
        ('share/wall_alarm', ['package.xml']),
        ('share/wall_alarm/launch', ['launch/wall_alarm.launch.py']),
        ('share/wall_alarm/config', ['config/wall_alarm.yaml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Robot Course',
    maintainer_email='robot.course@example.com',
    description='An alarm that goes off when the lidar sees something near',
    license='Apache-2.0',
    extras_require={'test': ['pytest']},
    entry_points={'console_scripts': ['alarm = wall_alarm.nodes.alarm:main']},
)
