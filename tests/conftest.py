"""What all tests share: hypothesis without deadlines, how long fuzz tests are, one thread where workers share cores,
failures named as they come, and what becomes of tests that need OpenFOAM where it is not."""

import os
import sys
from pathlib import Path

import pytest
from hypothesis import settings

# The first call of a kernel compiles it, which no deadline foresees; the same examples in every run.
settings.register_profile("sdph", deadline=None, max_examples=60, derandomize=True)
settings.load_profile("sdph")


# Tests take helpers and fixtures from each other by bare names, whatever folder these are in: every file has a name of
# its own.
sys.path += sorted(str(folder) for folder in Path(__file__).parent.rglob("*/") if folder.name != "__pycache__")

# Workers side by side have a core each; what threads do is the matter of tests/running/test_threads.py.
if "PYTEST_XDIST_WORKER" in os.environ:
    os.environ.setdefault("NUMBA_NUM_THREADS", "1")

# Files of several minutes each begin first, so that workers end together; without workers files keep their order.
FIRST = (
    "test_short_forms", "test_ranks_of_grains", "test_threads", "test_ranks", "test_grains_on_device",
    "test_device_of_mps", "test_ranks_of_moving_particles", "test_limits",
)  # fmt: skip

LAST = "test_planted_faults"  # its trials take over the kernels that others have compiled, and have a limit of time

LONG = int(os.environ.get("SDPH_LONG", "1"))  # times as many examples of the fuzz tests


def pytest_configure(config):
    config.addinivalue_line("markers", "openfoam: needs OpenFOAM; skipped without it, but fails in CI (CI=true)")
    if "PYTEST_XDIST_WORKER" not in os.environ:
        config.pluginmanager.register(Failures(config))


def pytest_collection_modifyitems(config, items):
    if not hasattr(config, "workerinput"):  # a trial of a fault begins with what is likeliest to see it
        return
    order = {name: number for number, name in enumerate(FIRST)} | {LAST: len(FIRST) + 1}
    items.sort(key=lambda item: order.get(item.path.stem, len(FIRST)))


class Failures:
    """Names a test that fails at once: a job that is ended before its time would not come to tell."""

    def __init__(self, config):
        self.config = config

    @pytest.hookimpl(trylast=True)
    def pytest_runtest_logreport(self, report):
        terminal = self.config.pluginmanager.get_plugin("terminalreporter")
        if report.failed and terminal:
            terminal.write_line(f"\nFAILED {report.nodeid} ({report.when}): {str(report.longrepr)[-2000:]}")


@pytest.hookimpl(tryfirst=True)  # before fixtures that would start a solver
def pytest_runtest_setup(item):
    if item.get_closest_marker("openfoam") is None:
        return
    from coupling.openfoam.programs import install

    if install.find() is None:
        missing = "OpenFOAM was not found; get it with `sdph openfoam setup --install`"
        pytest.fail(missing) if os.environ.get("CI") == "true" else pytest.skip(missing)
