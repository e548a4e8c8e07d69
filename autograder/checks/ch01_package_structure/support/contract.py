"""The contract of the exercises: the names that the checks use, and the addresses of the pages to read."""

from __future__ import annotations

import math

SQUARE_DANCE = "square_dance"
DANCER = "dancer"
DANCE_LAUNCH = "launch/square_dance.launch.py"
DANCE_CONFIG = "config/square_dance.yaml"
EMPTY_FILES = (
    "resource/square_dance",
    "square_dance/__init__.py",
    "square_dance/nodes/__init__.py",
    "square_dance/utils/__init__.py",
)
SIDE, CONFIGURED_SIDE = 1.0, 1.5  # m: the default of the node, and the value in the configuration
SPEED = 0.25  # m/s, along a side
TURN = math.pi / 8  # rad/s, at a corner

WALL_ALARM = "wall_alarm"
ALARM = "alarm"
ALARM_CONFIG = "config/wall_alarm.yaml"
NEAR = 0.8  # m: the distance in the alarm's configuration

LICENCE = "Apache-2.0"
# The classifiers in setup.py that agree with this licence.
CLASSIFIERS = ("License :: OSI Approved", "License :: OSI Approved :: Apache Software License")
BUILD_TYPE = "ament_python"

DOCS = "https://docs.ros.org/en/jazzy/"
CREATE = f"{DOCS}Tutorials/Beginner-Client-Libraries/Creating-Your-First-ROS2-Package.html"
DEVELOP = f"{DOCS}How-To-Guides/Developing-a-ROS-2-Package.html"
ROSDEP = f"{DOCS}Tutorials/Intermediate/Rosdep.html"
COLCON = f"{DOCS}Tutorials/Beginner-Client-Libraries/Colcon-Tutorial.html"
SUBPACKAGES = "https://setuptools.pypa.io/en/latest/userguide/package_discovery.html"
REP_149 = "https://www.ros.org/reps/rep-0149.html"
