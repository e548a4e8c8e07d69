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

"""A ROS 2 context of its own for each test, so that no test hears another one."""

import os
import time

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor

DEADLINE = 10.0  # s; only a broken node or network makes a test wait this long


class World:
    """A context with an executor, which runs the nodes of one test."""

    def __init__(self, context):
        self.context = context
        self.executor = SingleThreadedExecutor(context=context)

    def add(self, node):
        """Add the node to the executor, and return it."""
        self.executor.add_node(node)
        return node

    def until(self, condition):
        """Spin until the condition holds, or fail."""
        deadline = time.monotonic() + DEADLINE
        while not condition():
            assert time.monotonic() < deadline, f'still not true after {DEADLINE:g} s'
            self.executor.spin_once(timeout_sec=0.05)


@pytest.fixture
def world():
    """Give the test a world in a domain that other test processes are unlikely to use."""
    context = Context()
    rclpy.init(context=context, domain_id=1 + os.getpid() % 100)
    here = World(context)
    yield here
    for node in here.executor.get_nodes():
        node.destroy_node()
    here.executor.shutdown()
    rclpy.try_shutdown(context=context)
