"""The contracts of the exercises: the definitions' tables, the names that the checks use, and the pages to read."""

from __future__ import annotations

from autograder.probes.interfaces import Constant, Field, Interface, Part

INTERFACES = "my_robot_interfaces"
PACKAGE = "my_robot_package"
STATUS = "status_publisher"
DRIVER = "distance_driver"
MAX_LEGS = 8  # of a trip

ROBOT_STATUS = Interface(
    "msg/RobotStatus.msg",
    (
        Part(
            (
                Field("std_msgs/Header", "header"),
                Field("string", "robot_name"),
                Field("int32", "battery_level", -1),
                Field("bool", "is_charging"),
                Field("float32[]", "joint_positions"),
            ),
            (Constant("int32", "BATTERY_UNKNOWN", -1),),
        ),
    ),
)
CHECK_TRIP = Interface(
    "srv/CheckTrip.srv",
    (
        Part(
            (Field(f"float64[<={MAX_LEGS}]", "legs"), Field("int32", "reserve", 20)),
            (Constant("float64", "METRES_PER_PERCENT", 5.0),),
        ),
        Part((Field("bool", "possible"), Field("int32", "battery_at_end", -1), Field("string<=80", "reason"))),
    ),
)
DRIVE_DISTANCE = Interface(
    "action/DriveDistance.action",
    (
        Part(
            (Field("float64", "distance"), Field("float64", "speed", 0.2)),
            (Constant("float64", "MAX_DISTANCE", 5.0), Constant("float64", "MAX_SPEED", 0.5)),
        ),
        Part((Field("float64", "driven"), Field("string<=80", "reason"))),
        Part((Field("float64", "driven"), Field("float64", "remaining"))),
    ),
)
DEFINITIONS = (ROBOT_STATUS, CHECK_TRIP, DRIVE_DISTANCE)

UNKNOWN = -1  # percent
RESERVE = 20  # percent
METRES_PER_PERCENT = 5.0  # m
MAX_DISTANCE = 5.0  # m
MAX_SPEED = 0.5  # m/s
PERIOD = 0.1  # s between two commands
MAX_REASON = 80  # characters that fit into a reason
PATIENCE = 1.0  # s without progress until a goal is given up

DOCS = "https://docs.ros.org/en/jazzy/"
DEFINE = f"{DOCS}Tutorials/Beginner-Client-Libraries/Custom-ROS2-Interfaces.html"
LANGUAGE = f"{DOCS}Concepts/Basic/About-Interfaces.html"
SERVICE = f"{DOCS}Tutorials/Beginner-Client-Libraries/Writing-A-Simple-Py-Service-And-Client.html"
ACTION = f"{DOCS}Tutorials/Intermediate/Writing-an-Action-Server-Client/Py.html"
GROUPS = f"{DOCS}How-To-Guides/Using-callback-groups.html"
BATTERY = f"{DOCS}p/sensor_msgs/msg/BatteryState.html"
QOS = f"{DOCS}Concepts/Intermediate/About-Quality-of-Service-Settings.html"
