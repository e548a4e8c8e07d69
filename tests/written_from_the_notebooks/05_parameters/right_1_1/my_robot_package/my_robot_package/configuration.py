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

"""The six settings of the robot, in a table, and how two of them depend on each other."""

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor

SETTINGS = (
    # name, default, limits, description
    ('battery_threshold', 20, (0, 100), 'with less charge than this (percent) it stands'),
    ('control_frequency', 10.0, (1.0, 50.0), 'rate of the commands (Hz)'),
    ('slow_distance', 1.0, (0.2, 3.0), 'obstacles nearer than this (m) make it slower'),
    ('safety_distance', 0.5, (0.2, 3.0), 'it stands before an obstacle that is so near (m)'),
    ('max_linear_velocity', 0.3, (0.0, 1.0), 'it never drives faster than this (m/s)'),
    ('robot_name', 'DefaultRobot', None, 'what to call it'),
)


def contradiction(safety_distance, slow_distance):
    """Return what is wrong with two distances, and nothing at all when they fit."""
    sentences = {
        True: '',
        False: f'A safety_distance of {safety_distance} m does not fit '
               f'a slow_distance of {slow_distance} m, which has to be greater.',
    }
    return sentences[bool(safety_distance < slow_distance)]


def _descriptor(description, limits):
    descriptor = ParameterDescriptor()
    descriptor.description = description
    if limits is None:
        descriptor.read_only = True
    elif isinstance(limits[0], int):
        descriptor.integer_range.append(IntegerRange(from_value=limits[0], to_value=limits[1]))
    else:
        descriptor.floating_point_range.append(
            FloatingPointRange(from_value=limits[0], to_value=limits[1]))
    return descriptor


def declare_configuration(node):
    """Declare each line of the table; raise ValueError when the two distances do not fit."""
    started_with = {}
    for name, default, limits, description in SETTINGS:
        parameter = node.declare_parameter(name, default, _descriptor(description, limits))
        started_with[name] = parameter.value
    sentence = contradiction(started_with['safety_distance'], started_with['slow_distance'])
    if sentence != '':
        raise ValueError(sentence)
