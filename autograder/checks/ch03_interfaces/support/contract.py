"""The contracts of the exercises: the definitions' tables, the names that the checks use, and the pages to read."""

from __future__ import annotations

from autograder.checking.probes import interfaces

INTERFACES = "my_robot_interfaces"
PACKAGE = "my_robot_package"
STATUS = "status_publisher"
DRIVER = "distance_driver"
MAX_LEGS = 8  # the largest number of legs in a trip

ROBOT_STATUS = interfaces.Interface(
    "msg/RobotStatus.msg",
    (
        interfaces.Part(
            (
                interfaces.Field("std_msgs/Header", "header"),
                interfaces.Field("string", "robot_name"),
                interfaces.Field("int32", "battery_level", -1),
                interfaces.Field("bool", "is_charging"),
                interfaces.Field("float32[]", "joint_positions"),
            ),
            (interfaces.Constant("int32", "BATTERY_UNKNOWN", -1),),
        ),
    ),
)
CHECK_TRIP = interfaces.Interface(
    "srv/CheckTrip.srv",
    (
        interfaces.Part(
            (interfaces.Field(f"float64[<={MAX_LEGS}]", "legs"), interfaces.Field("int32", "reserve", 20)),
            (interfaces.Constant("float64", "METRES_PER_PERCENT", 5.0),),
        ),
        interfaces.Part(
            (
                interfaces.Field("bool", "possible"),
                interfaces.Field("int32", "battery_at_end", -1),
                interfaces.Field("string<=80", "reason"),
            )
        ),
    ),
)
DRIVE_DISTANCE = interfaces.Interface(
    "action/DriveDistance.action",
    (
        interfaces.Part(
            (interfaces.Field("float64", "distance"), interfaces.Field("float64", "speed", 0.2)),
            (interfaces.Constant("float64", "MAX_DISTANCE", 5.0), interfaces.Constant("float64", "MAX_SPEED", 0.5)),
        ),
        interfaces.Part((interfaces.Field("float64", "driven"), interfaces.Field("string<=80", "reason"))),
        interfaces.Part((interfaces.Field("float64", "driven"), interfaces.Field("float64", "remaining"))),
    ),
)
DEFINITIONS = (ROBOT_STATUS, CHECK_TRIP, DRIVE_DISTANCE)

UNKNOWN = -1  # percent: the value for a level that is not known
RESERVE = 20  # percent, by default
METRES_PER_PERCENT = 5.0  # m that one percent of the charge lasts
MAX_DISTANCE = 5.0  # m, of a goal
MAX_SPEED = 0.5  # m/s, of a goal
PERIOD = 0.1  # s between two commands
MAX_REASON = 80  # characters of a reason
PATIENCE = 1.0  # s without progress until a goal is aborted

DOCS = "https://docs.ros.org/en/jazzy/"
DEFINE = f"{DOCS}Tutorials/Beginner-Client-Libraries/Custom-ROS2-Interfaces.html"
LANGUAGE = f"{DOCS}Concepts/Basic/About-Interfaces.html"
SERVICE = f"{DOCS}Tutorials/Beginner-Client-Libraries/Writing-A-Simple-Py-Service-And-Client.html"
ACTION = f"{DOCS}Tutorials/Intermediate/Writing-an-Action-Server-Client/Py.html"
GROUPS = f"{DOCS}How-To-Guides/Using-callback-groups.html"
BATTERY = f"{DOCS}p/sensor_msgs/msg/BatteryState.html"
QOS = f"{DOCS}Concepts/Intermediate/About-Quality-of-Service-Settings.html"
