from setuptools import find_packages, setup

setup(
    name='motor_guard',
    version='1.2.3',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/motor_guard']),
        ('share/motor_guard', ['package.xml']),
        ('share/motor_guard/launch', ['launch/motor_guard.launch.py']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Ada',
    maintainer_email='ada@example.org',
    description='A fan for a motor',
    license='Apache-2.0',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [
            f'{name} = motor_guard.{name}:main' for name in ('guard', 'smoother', 'thermometer')
        ],
    },
)
