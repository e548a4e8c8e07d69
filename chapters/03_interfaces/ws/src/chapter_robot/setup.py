from glob import glob
import os

from setuptools import find_packages, setup

package_name = 'chapter_robot'

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        # Include custom message files
        (os.path.join('share', package_name, 'msg'), glob('msg/*.msg')),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Robot Course',
    maintainer_email='robot.course@example.com',
    description="The chapter's message, packed as the chapter says",
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'status_publisher = chapter_robot.status_publisher:main',
        ],
    },
)
