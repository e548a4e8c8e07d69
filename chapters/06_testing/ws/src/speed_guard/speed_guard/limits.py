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

"""How fast a robot may go, by the distance to the nearest thing in front of it."""

import math


def safe_speed(wanted, distance, stop_distance=0.5, slow_distance=1.5):
    """
    Return the speed in m/s that is allowed where `wanted` m/s are asked for.

    wanted is a finite number. distance is how far away the nearest thing in front is, in m:
    inf when nothing is there, None or nan when that is not known. The first line that fits
    decides:

    not 0 <= stop_distance < slow_distance    ValueError
    wanted <= 0                               wanted: the way back is not guarded
    distance is None or nan                   0.0
    distance <= stop_distance                 0.0
    distance >= slow_distance                 wanted
    otherwise                                 grows linearly, from 0.0 at stop_distance
                                              to wanted at slow_distance
    """
    if not 0.0 <= stop_distance < slow_distance:
        raise ValueError(
            f'0 <= stop_distance < slow_distance must hold, not {stop_distance}, {slow_distance}')
    if wanted <= 0.0:
        return wanted
    if distance is None or math.isnan(distance):
        return 0.0
    share = (distance - stop_distance) / (slow_distance - stop_distance)
    return wanted * min(max(share, 0.0), 1.0)
