from glob import glob

from setuptools import find_packages, setup

package_name = 'motor_guard'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/launch', glob('launch/*.launch.py')),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Robot Course',
    maintainer_email='robot.course@example.com',
    description='Keeps a motor cool: a thermometer, a moving average and a decision',
    license='Apache-2.0',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [
            'thermometer = motor_guard.thermometer:main',
            'smoother = motor_guard.smoother:main',
            'guard = motor_guard.guard:main',
        ],
    },
)
