from setuptools import setup

setup(
    name="greeting",
    version="0.1.0",
    packages=["greeting"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/greeting"]),
        ("share/greeting", ["package.xml"]),
    ],
)
