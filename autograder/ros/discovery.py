"""Faster DDS discovery: a participant announces itself ten times a second.

Fast DDS announces a participant five times in its first half second, and then every 3 s. Measured with the wheels, a
participant that joins others is as often as not found only by the next of these: after 3 s, where 0.3 s would do.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PROFILES_VARIABLE = "FASTRTPS_DEFAULT_PROFILES_FILE"
PROFILES = Path(__file__).with_name("announces_often.xml")


@contextmanager
def announcing_often() -> Iterator[None]:
    """Let the participants of a `rclpy.init` in the block announce themselves often.

    Fast DDS reads its profiles at the first `init` of a process: they hold for all that follow, and come too
    late for a process that has one already. Profiles that the user has chosen stay.
    """
    if PROFILES_VARIABLE in os.environ:
        yield
        return
    os.environ[PROFILES_VARIABLE] = str(PROFILES)
    try:
        yield
    finally:
        del os.environ[PROFILES_VARIABLE]
