"""Meeting others at once: a DDS participant that goes on announcing itself while it is young and after.

Fast DDS announces a participant five times in its first half second, and then every 3 s. Measured with the wheels, a
participant that joins others is as often as not found only by the next of these: after 3 s, where 0.3 s would do. Who
looks at a graph, or waits for nodes that start one after another, announces itself ten times a second instead.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager

PROFILES_VARIABLE = "FASTRTPS_DEFAULT_PROFILES_FILE"
PROFILES = """<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles"><profiles>
  <participant profile_name="announces often" is_default_profile="true"><rtps><builtin><discovery_config>
    <leaseAnnouncement><sec>0</sec><nanosec>100000000</nanosec></leaseAnnouncement>
  </discovery_config></builtin></rtps></participant>
</profiles></dds>
"""


@contextmanager
def announcing_often() -> Iterator[None]:
    """Let the participants of a `rclpy.init` in the block announce themselves often.

    Fast DDS reads its profiles at the first `init` of a process: they hold for all that follow, and come too
    late for a process that has one already. Profiles that the user has chosen stay.
    """
    if PROFILES_VARIABLE in os.environ:
        yield
        return
    with tempfile.NamedTemporaryFile("w", suffix=".xml") as file:
        file.write(PROFILES)
        file.flush()
        os.environ[PROFILES_VARIABLE] = file.name
        try:
            yield
        finally:
            del os.environ[PROFILES_VARIABLE]
