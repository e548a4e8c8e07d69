import glob
import os

import setuptools

NAME = 'motor_guard'
SHARE = os.path.join('share', NAME)

setuptools.setup(
    name=NAME,
    version='0.1.0',
    license='Apache-2.0',
    description='Decides when the fan of a motor runs',
    author='Robot Course',
    author_email='robot.course@example.com',
    maintainer='Robot Course',
    maintainer_email='robot.course@example.com',
    packages=[NAME],
    install_requires=['setuptools'],
    extras_require=dict(test=['pytest']),
    zip_safe=False,
    data_files=[
        (os.path.join('share', 'ament_index', 'resource_index', 'packages'),
         [os.path.join('resource', NAME)]),
        (SHARE, ['package.xml']),
        (os.path.join(SHARE, 'launch'), glob.glob(os.path.join('launch', '*launch.py'))),
    ],
    entry_points="""
[console_scripts]
guard = motor_guard.guard:main
smoother = motor_guard.smoother:main
thermometer = motor_guard.thermometer:main
""",
)
