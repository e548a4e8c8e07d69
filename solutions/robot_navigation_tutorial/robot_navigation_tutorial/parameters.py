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

"""Numeric parameters with a range."""

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor


def declare(node, name, default, lowest, highest, description):
    """
    Declare a numeric parameter of a node, with a description and a range.

    rclpy rejects a value of another type, and a value below lowest or above highest, at the
    start and later. The node calls get_parameter(name).value whenever it needs the number, so a
    change takes effect immediately.
    """
    bounds = FloatingPointRange(from_value=lowest, to_value=highest)
    node.declare_parameter(
        name, default, ParameterDescriptor(
            description=description, floating_point_range=[bounds]))
