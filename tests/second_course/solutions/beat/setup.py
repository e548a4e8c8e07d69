from setuptools import setup

setup(
    name="beat",
    version="0.1.0",
    packages=["beat"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/beat"]),
        ("share/beat", ["package.xml"]),
    ],
    entry_points={"console_scripts": ["beat = beat.beat:main"]},
)
