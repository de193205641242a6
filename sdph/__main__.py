"""`python -m sdph`: the same as the command `sdph`."""

import sys

from sdph.cli import main

if __name__ == "__main__":
    sys.exit(main())
