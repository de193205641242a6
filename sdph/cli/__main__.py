"""`python -m sdph.cli`: the same as the command `sdph`."""

import sys

from sdph.cli import main

sys.exit(main())
