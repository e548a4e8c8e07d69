"""`python -m autograder.ros.ros2`."""

import sys

from autograder.ros.ros2.main import main

sys.exit(main())
