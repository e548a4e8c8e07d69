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

"""The choice of a turn, by a function that remembers the current one."""

MARGIN = 0.1


def pilot():
    """Return a function from distances to a side: 1 for left, -1 for right, 0 for straight on."""
    side = 0

    def decide(front, left, right, limit):
        nonlocal side
        if side == 0 and front < limit:
            side = -1 if right > left else 1
        elif side != 0 and front >= limit + MARGIN:
            side = 0
        return side

    return decide
