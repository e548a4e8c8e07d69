"""All that can be said without code stands in setup.cfg."""

from pathlib import Path

from setuptools import setup

NAME = 'square_dance'
share = Path('share') / NAME
index = Path('share/ament_index/resource_index/packages')


def installed_files():
    """Yield each folder below share with the files that go into it."""
    yield str(index), [f'resource/{NAME}']
    yield str(share), ['package.xml']
    for folder in ('launch', 'config'):
        here = sorted(path for path in Path(folder).rglob('*') if path.is_file())
        for parent in sorted({path.parent for path in here}):
            yield str(share / parent), [str(path) for path in here if path.parent == parent]


setup(data_files=list(installed_files()))
