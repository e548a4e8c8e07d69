"""`python -m ament_copyright`."""

import sys

from .main import main

sys.exit(main())
