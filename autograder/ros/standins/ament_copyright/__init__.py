"""A stand-in for `ament_copyright`, which has no wheel: does each source file say whose it is, and its licence?

It is found only where the real package is not importable. Covered: `main(argv)` with paths, `--exclude`,
`--verbose`, `--list-licenses` and `--xunit-file`. Get the real one by sourcing a ROS 2 Jazzy installation.
"""

from standin_notice import make_getattr
from standin_submodules import install_submodule_finder

from .main import main

__all__ = ["main"]

__getattr__ = make_getattr(__name__)

install_submodule_finder()
