"""Signals that end a comparison end what it started."""

import os
import signal
import time

import pytest

from sdph import cli
from sdph.study import against


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_a_signal_unwinds_a_comparison(number, monkeypatch, capsys):
    """So that OpenFOAM's program, which is ended where its run is left, does not go on without it."""
    ended = []

    def comparing(*given):
        try:
            os.kill(os.getpid(), number)
            time.sleep(5.0)
        finally:
            ended.append(given)

    monkeypatch.setattr(against, "compare", comparing)
    before = signal.getsignal(number)
    assert cli.main(["compare", "run", "--against", "tfm"]) == 128 + number
    assert len(ended) == 1 and signal.getsignal(number) is before
    assert capsys.readouterr().err.count("\n") == 1
