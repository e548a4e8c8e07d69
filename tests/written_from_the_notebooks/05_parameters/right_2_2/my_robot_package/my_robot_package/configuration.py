# Copyright 2026 The ROS 2 Python Course Authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
What can be configured.

Each parameter is a class of its own, and declares itself.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node


def contradiction(safety_distance: float, slow_distance: float) -> str:
    """Return the reason why the robot cannot drive by these distances (m); empty: it can."""
    if not safety_distance < slow_distance:
        return ' '.join((
            'The robot has to slow down before it stops, but',
            f'slow_distance is {slow_distance!r} and safety_distance is {safety_distance!r}'))
    return ''


@dataclass(frozen=True)
class _Setting(ABC):
    """A parameter: what is common to all types."""

    name: str
    default: Any
    meaning: str
    limits: tuple = ()

    @abstractmethod
    def restrict(self, descriptor: ParameterDescriptor) -> None:
        """Write into the descriptor what is not allowed."""

    def declare(self, node: Node) -> Any:
        """Declare the parameter on a node; return the value that it has there."""
        descriptor = ParameterDescriptor(name=self.name, description=self.meaning)
        self.restrict(descriptor)
        return node.declare_parameter(self.name, self.default, descriptor).value


class _Fixed(_Setting):
    """Whoever starts the node decides, nobody else."""

    def restrict(self, descriptor):
        descriptor.read_only = True


class _Real(_Setting):
    """A double."""

    def restrict(self, descriptor):
        interval = FloatingPointRange()
        interval.from_value, interval.to_value = self.limits
        descriptor.floating_point_range.append(interval)


class _Whole(_Setting):
    """An integer."""

    def restrict(self, descriptor):
        interval = IntegerRange()
        interval.from_value, interval.to_value, interval.step = *self.limits, 1
        descriptor.integer_range.append(interval)


SETTINGS = (
    _Fixed('robot_name', 'DefaultRobot', 'Name of the robot, fixed once it has started'),
    _Real('max_linear_velocity', 0.3, 'Speed on a free way (m/s)', (0.0, 1.0)),
    _Real('safety_distance', 0.5, 'The robot stops this far (in m) from a thing', (0.2, 3.0)),
    _Real('slow_distance', 1.0, 'The robot brakes from this far (in m) on', (0.2, 3.0)),
    _Real('control_frequency', 10.0, 'Commands per second, that is, Hz', (1.0, 50.0)),
    _Whole('battery_threshold', 20, 'Below this charge (percent) it rests', (0, 100)),
)


def declare_configuration(node: Node) -> None:
    """Declare all settings; raise ValueError, which says why, if two of them do not fit."""
    values = {setting.name: setting.declare(node) for setting in SETTINGS}
    if why := contradiction(values['safety_distance'], values['slow_distance']):
        raise ValueError(why)
