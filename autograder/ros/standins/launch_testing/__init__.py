"""Stand-in for `launch_testing`, which cannot be installed by pip: the parts that `launch_pytest` tests use.

It is imported only where the real package is not. Covered are `actions.ReadyToTest` and
`util.KeepAliveProc`; the package's own runner (`launch_test`, ``generate_test_description``) is not: write
the test with `launch_pytest`, or run `make real-launch`, or source an installation of ROS 2 Jazzy.
"""

from __future__ import annotations

from standin_notice import guard

from . import actions, util

__all__ = ["actions", "util"]

__getattr__ = guard(__name__)
