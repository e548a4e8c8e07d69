"""Install the data files; setup.cfg contains everything that needs no code."""

from pathlib import Path

from setuptools import setup

NAME = 'square_dance'
share = Path('share') / NAME
index = Path('share/ament_index/resource_index/packages')


def installed_files():
    """Yield each folder below share with the files to install there."""
    yield str(index), [f'resource/{NAME}']
    yield str(share), ['package.xml']
    for folder in ('launch', 'config'):
        files = sorted(path for path in Path(folder).rglob('*') if path.is_file())
        for parent in sorted({path.parent for path in files}):
            yield str(share / parent), [str(path) for path in files if path.parent == parent]


setup(data_files=list(installed_files()))
