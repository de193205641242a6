"""One fault in the copy of the tree, the tests that should see it, and the first that does."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

from .fault import Fault
from .rooms import seen_by
from .tree import Tree

PYTEST = (sys.executable, "-m", "pytest", "-x", "-q", "--no-header", "-p", "no:cacheprovider", "-p", "no:xdist")
BUILD = "from coupling.openfoam.programs import build, install; build.build(install.GAS_SOLVER)"
CAUGHT, SURVIVED, LATE, UNBUILT = "caught", "survived", "out of time", "does not compile"


class Outcome(NamedTuple):
    """What became of a fault; the test that saw it; seconds that it took."""

    what: str
    test: str
    seconds: float


class Laboratory:
    """Trials in a copy of the tree at `root`; tests that fail without a fault too are left out."""

    def __init__(self, root: Path, place: Path, limit: float):
        self.original, self.limit = root, limit
        self.tree = Tree(root, place)
        self.broken: list[str] = []
        self.sound: set[str] = set()

    def trial(self, fault: Fault) -> Outcome:
        """Plant it, run the tests up to the first failure, and take it out again."""
        began = time.monotonic()
        while True:
            what, test = self._seen(fault)
            if what != CAUGHT or self._sound(test):
                return Outcome(what, test, time.monotonic() - began)
            if test in self.broken:
                raise RuntimeError(f"{test} fails without a fault too, and is not left out when asked: look at pytest")
            self.broken.append(test)

    def _seen(self, fault: Fault) -> tuple[str, str]:
        self.tree.plant(fault)
        try:
            if fault.file.endswith((".C", ".H")) and not self._builds():
                return UNBUILT, ""
            return self._run(seen_by(self.original, fault.room, fault.file), self.tree.fault_cache)
        finally:
            self.tree.restore(fault)

    def _sound(self, test: str) -> bool:
        """Whether a test passes without the fault."""
        if test not in self.sound and self._run([test], self.tree.clean_cache)[0] == SURVIVED:
            self.sound.add(test)
        return test in self.sound

    def _builds(self) -> bool:
        command = [sys.executable, "-c", BUILD]
        environment = self.tree.environment(self.tree.clean_cache)
        return subprocess.run(command, cwd=self.tree.root, env=environment, capture_output=True).returncode == 0

    def _run(self, names: list[str], cache: Path) -> tuple[str, str]:
        """Outcome, and the test that failed, or what pytest last said."""
        left_out = [f"--{'deselect' if '::' in test else 'ignore'}={test}" for test in self.broken]
        process = subprocess.Popen(
            [*PYTEST, *left_out, *names], cwd=self.tree.root, env=self.tree.environment(cache), text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True,
        )  # fmt: skip
        try:
            said, _ = process.communicate(timeout=self.limit)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            return LATE, ""
        if process.returncode == 0:
            return SURVIVED, ""
        failed = re.search(r"^(?:FAILED|ERROR) (\S+)", said, re.MULTILINE)
        return CAUGHT, failed.group(1) if failed else names[0]
