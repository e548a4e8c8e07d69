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

"""Names, defaults, limits and meanings of what can be set."""

from rcl_interfaces.msg import FloatingPointRange as Range
from rcl_interfaces.msg import IntegerRange
from rcl_interfaces.msg import ParameterDescriptor as Descriptor


def contradiction(safety_distance, slow_distance):
    """Compare two distances (m); return '' if the first one is below the second one."""
    if not safety_distance < slow_distance:
        return 'safety_distance must be below slow_distance, but they are {!r} and {!r}'.format(
            safety_distance, slow_distance)
    return ''


def declare_configuration(node):
    """Declare all parameters in one call, and look at the two that have to fit together."""
    near, far = Range(from_value=0.2, to_value=3.0), Range(from_value=0.2, to_value=3.0)
    speeds, rates = Range(from_value=0.0, to_value=1.0), Range(from_value=1.0, to_value=50.0)
    _, _, safety, slow, _, _ = node.declare_parameters(namespace='', parameters=[
        ('robot_name', 'DefaultRobot', Descriptor(
            description='A name for people, which stays the same as long as the node runs.',
            read_only=True)),
        ('max_linear_velocity', 0.3, Descriptor(
            description='Speed on a clear way. Unit: m/s', floating_point_range=[speeds])),
        ('safety_distance', 0.5, Descriptor(
            description='Distance at which it has stopped. Unit: m', floating_point_range=[near])),
        ('slow_distance', 1.0, Descriptor(
            description='Distance at which it begins to brake. Unit: m',
            floating_point_range=[far])),
        ('control_frequency', 10.0, Descriptor(
            description='Commands in each second. Unit: Hz', floating_point_range=[rates])),
        ('battery_threshold', 20, Descriptor(
            description='Charge that it needs to drive. Unit: percent',
            integer_range=[IntegerRange(from_value=0, to_value=100, step=1)])),
    ])
    problem = contradiction(safety.value, slow.value)
    if problem:
        raise ValueError(problem)
