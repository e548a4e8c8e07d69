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

"""The node that processes: the moving average of the newest readings."""

from collections import deque
import math

from motor_guard_interfaces.msg import Temperature
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from rclpy.node import Node

from motor_guard.running import run


class Smoother(Node):
    """
    Publishes one average for each reading that is finite.

    Subscribes to temperature, publishes smoothed, both motor_guard_interfaces/Temperature.
    """

    def __init__(self, **kwargs):
        """
        Name the node smoother; declare its parameter, create its topics.

        window: the number of readings in an average, an integer from 1 to 100, by default 5.
        kwargs are passed on to Node.
        """
        super().__init__('smoother', **kwargs)
        window = self.declare_parameter('window', 5, ParameterDescriptor(
            description='how many readings an average is taken over',
            integer_range=[IntegerRange(from_value=1, to_value=100)])).value
        self.newest = deque(maxlen=window)
        self.publisher = self.create_publisher(Temperature, 'smoothed', 10)
        self.create_subscription(Temperature, 'temperature', self.temperature_callback, 10)

    def temperature_callback(self, reading):
        """
        Publish the mean of the newest readings, with the stamp of the newest one.

        A reading that is not finite is ignored: it is not put into the window, and nothing
        is published for it.
        """
        if not math.isfinite(reading.celsius):
            return
        self.newest.append(reading.celsius)
        mean = sum(self.newest) / len(self.newest)
        self.publisher.publish(Temperature(stamp=reading.stamp, celsius=mean))


def main(args=None):
    """Run the node until it is told to stop."""
    run(Smoother, args)


if __name__ == '__main__':
    main()
