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

"""The states of the robot; each state returns the next one."""

MARGIN = 0.1


class Straight:
    """Drives straight on."""

    side = 0

    def next(self, clearance, limit):
        """Return a turn if something is nearer than the limit, otherwise this state."""
        if clearance.front >= limit:
            return self
        return Turning(1 if clearance.left >= clearance.right else -1)


class Turning:
    """Turns to one side until the way is clear."""

    def __init__(self, side):
        """Set the side: 1 is left, -1 right."""
        self.side = side

    def next(self, clearance, limit):
        """Return Straight once the way is clear, otherwise this state."""
        return Straight() if clearance.front - limit >= MARGIN else self
