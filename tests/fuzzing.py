"""Size and seed of the fuzz tests: `SDPH_FUZZ=50 SDPH_FUZZ_SEED=7 pytest -k fuzz` is the long form with other harm than
that of CI."""

import os

FACTOR = int(os.environ.get("SDPH_FUZZ", "1"))  # times the cases of the short form
SEED = int(os.environ.get("SDPH_FUZZ_SEED", "0"))  # added to each seed
