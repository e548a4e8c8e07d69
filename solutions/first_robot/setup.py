from setuptools import find_packages, setup

package_name = 'first_robot'

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
    description='Two robots that drive without looking: one in a circle, one in a square',
    license='Apache-2.0',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [
            'circle = first_robot.circle:main',
            'square = first_robot.square:main',
        ],
    },
)
