"""A method whose stepper goes forward by itself: what all of them share (sdph.methods.method.Method)."""

from __future__ import annotations

import contextlib

import numpy as np

from sdph.engine.kept import Unfit


class Stepped:
    """State, time and steps are those of `stepper`; `advance` counts `windows`; `ledger` has a row a window."""

    pushed = None  # no walls of it have names

    @property
    def state(self):
        return self.stepper.state

    @property
    def time(self) -> float:
        return self.stepper.time

    @property
    def steps(self) -> int:
        return self.stepper.steps

    @property
    def limit(self) -> str:
        return self.stepper.limit

    def tables(self) -> list:
        """Files that grow by rows."""
        return [self.ledger.table]

    def start(self) -> None:
        self.ledger.open(self.stepper)

    def admit(self, kept: dict) -> None:
        """Unfit where time is not that of the ledger."""
        if kept["stepper"]["time"] != kept["ledger"]["last"]["time_s"]:
            raise Unfit("its time is not that of the ledger")

    def whole(self):
        """Context in which the first process holds all particles; True there."""
        return contextlib.nullcontext(True)

    def news(self) -> list[str]:
        """Tell what befell it since it was last asked, for the user."""
        return []

    def begin(self) -> None:
        self.stepper.guard.begin(self)
        self.begun = self.time

    def advance(self, end: float, most: float = np.inf) -> None:
        """Go to `end` [s], or as far as `most` steps get."""
        done = 0
        while self.time != end and done < most:
            left = end - self.time
            if self.stepper.step(left) >= left:
                self.stepper.time = end
            done += 1
        self.windows += 1
