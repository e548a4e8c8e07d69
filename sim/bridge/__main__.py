"""`python -m sim.bridge --ros-args -p world:=lab.yaml`: the node alone, for a launch file."""

import sys

from sim.bridge.node import main

sys.exit(main())
