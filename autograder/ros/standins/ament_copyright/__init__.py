"""A stand-in for `ament_copyright`, which has no wheel: it checks that each source file has a copyright and a licence.

It is imported only if the real package is not installed. It covers `main(argv)` with paths, `--exclude`,
`--verbose`, `--list-licenses` and `--xunit-file`. For the real package, source an installation of ROS 2 Jazzy.
"""

from standin_notice import make_getattr
from standin_submodules import install_submodule_finder

from .main import main

__all__ = ["main"]

__getattr__ = make_getattr(__name__)

install_submodule_finder()
