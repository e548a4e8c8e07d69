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

"""What can be configured about the robot: each parameter's name, type, limits and meaning."""

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor


def contradiction(safety_distance, slow_distance):
    """
    Return a sentence that says why two distances (m) do not fit, or '' if they fit.

    The safety distance must be below the slow distance. The sentence contains the names and the
    values of both parameters.
    """
    if safety_distance < slow_distance:
        return ''
    return (
        f'safety_distance ({safety_distance:g} m) must be below '
        f'slow_distance ({slow_distance:g} m)')


def declare_configuration(node):
    """
    Declare the six parameters on a node, each with a default, a description and its limits.

    robot_name           string    'DefaultRobot'   read-only
    max_linear_velocity  double    0.3 m/s          0.0 to 1.0
    safety_distance      double    0.5 m            0.2 to 3.0
    slow_distance        double    1.0 m            0.2 to 3.0
    control_frequency    double    10.0 Hz          1.0 to 50.0
    battery_threshold    integer   20 percent       0 to 100

    Raise ValueError, with the sentence that contradiction() returns, if the node would
    start with distances that do not fit together.
    """
    node.declare_parameter(
        'robot_name', 'DefaultRobot',
        ParameterDescriptor(description='the name that the robot goes by', read_only=True))
    node.declare_parameter(
        'max_linear_velocity', 0.3,
        ParameterDescriptor(
            description='speed where the way is clear, in m/s',
            floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0)]))
    node.declare_parameter(
        'safety_distance', 0.5,
        ParameterDescriptor(
            description='how near to an obstacle the robot goes, in m',
            additional_constraints='below slow_distance',
            floating_point_range=[FloatingPointRange(from_value=0.2, to_value=3.0)]))
    node.declare_parameter(
        'slow_distance', 1.0,
        ParameterDescriptor(
            description='where the robot begins to slow down, in m',
            additional_constraints='above safety_distance',
            floating_point_range=[FloatingPointRange(from_value=0.2, to_value=3.0)]))
    node.declare_parameter(
        'control_frequency', 10.0,
        ParameterDescriptor(
            description='velocity commands a second, in Hz',
            floating_point_range=[FloatingPointRange(from_value=1.0, to_value=50.0)]))
    node.declare_parameter(
        'battery_threshold', 20,
        ParameterDescriptor(
            description='charge below which the robot stands still, in percent',
            integer_range=[IntegerRange(from_value=0, to_value=100)]))
    wrong = contradiction(
        node.get_parameter('safety_distance').value, node.get_parameter('slow_distance').value)
    if wrong:
        raise ValueError(wrong)
