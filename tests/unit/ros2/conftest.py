"""The stand-ins are importable here, whether or not the environment was set up with them."""

from __future__ import annotations

import sys

from autograder.ros.ros2.main import STANDINS_FOLDER

if str(STANDINS_FOLDER) not in sys.path:
    sys.path.append(str(STANDINS_FOLDER))
