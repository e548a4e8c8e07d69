from setuptools import setup

setup(
    name='NEW_PACKAGE',
    version='0.1.0',
    packages=['NEW_PACKAGE'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/NEW_PACKAGE']),
        ('share/NEW_PACKAGE', ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Robot Course',
    maintainer_email='robot.course@example.com',
    description='Publishes the distance to the nearest obstacle',
    license='Apache-2.0',
    entry_points={'console_scripts': ['NEW_NODE = NEW_PACKAGE.NEW_NODE:main']},
)
