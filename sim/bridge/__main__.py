"""Runs only the node, for launch files: `python -m sim.bridge --ros-args -p world:=lab.yaml`."""

import sys

from sim.bridge.node import main

sys.exit(main())
