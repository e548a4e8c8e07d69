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

"""The robot's parameters, as a table, and the one rule that a table of ranges cannot hold."""

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor

TABLE = (
    # name, default, lowest, highest, description
    ('robot_name', 'DefaultRobot', None, None, 'what to call this robot'),
    ('max_linear_velocity', 0.3, 0.0, 1.0, 'highest speed of the robot [m/s]'),
    ('safety_distance', 0.5, 0.2, 3.0, 'space to leave before an obstacle [m]'),
    ('slow_distance', 1.0, 0.2, 3.0, 'space before an obstacle, where braking begins [m]'),
    ('control_frequency', 10.0, 1.0, 50.0, 'rate of the velocity commands [Hz]'),
    ('battery_threshold', 20, 0, 100, 'least charge for driving [percent]'),
)


def contradiction(safety_distance, slow_distance):
    """Return '' for distances in the right order, else a sentence with names and values."""
    fits = slow_distance > safety_distance
    return '' if fits else (
        f'With safety_distance = {safety_distance} m, slow_distance = {slow_distance} m is too '
        'short: it has to be the greater one.')


def _descriptor(default, lowest, highest, description):
    """Return the descriptor for one line of the table; a text is fixed after the start."""
    descriptor = ParameterDescriptor(description=description)
    if isinstance(default, str):
        descriptor.read_only = True
    elif isinstance(default, int):
        descriptor.integer_range = [IntegerRange(from_value=lowest, to_value=highest)]
    else:
        descriptor.floating_point_range = [
            FloatingPointRange(from_value=lowest, to_value=highest)]
    return descriptor


def declare_configuration(node):
    """
    Declare each line of the table on the node.

    Raise ValueError when the two distances at the start contradict each other.
    """
    node.declare_parameters('', [
        (name, default, _descriptor(default, *limits_and_text))
        for name, default, *limits_and_text in TABLE
    ])
    distances = node.get_parameters(['safety_distance', 'slow_distance'])
    sentence = contradiction(*(distance.value for distance in distances))
    if sentence:
        raise ValueError(sentence)
