"""Signals: asked once, asked twice, and while a kernel is compiled."""

import os
import signal
import time

import pytest
from test_restart import load

from sdph.running import driver, interruption
from sdph.running.interruption import Stopped, listening
from sdph.running.progress import Reporter


def test_impatient_it_stops_at_once_and_patient_it_waits():
    with listening() as wish:
        with pytest.raises(Stopped):
            os.kill(os.getpid(), signal.SIGTERM)
            time.sleep(1.0)
        wish.patient = True
        os.kill(os.getpid(), signal.SIGTERM)
        assert wish.number == signal.SIGTERM
        with pytest.raises(Stopped):
            wish.obey(wish.number)


def test_whoever_does_not_obey_is_stopped_all_the_same(monkeypatch):
    """A gas that hangs lets no window end."""
    monkeypatch.setattr(interruption, "PATIENCE", 0.2)
    with listening() as wish, pytest.raises(Stopped):
        wish.patient = True
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(30.0)


def test_a_long_window_may_end(monkeypatch):
    """As long as those before it, twice: a polite stop loses nothing of a run whose windows take minutes."""
    monkeypatch.setattr(interruption, "PATIENCE", 0.1)
    with listening() as wish:
        wish.patient = True
        wish.allow(0.5)
        os.kill(os.getpid(), signal.SIGTERM)
        begun = time.monotonic()
        with pytest.raises(Stopped):
            time.sleep(30.0)
        assert 1.0 < time.monotonic() - begun < 10.0


def test_whoever_obeys_hears_no_more(monkeypatch):
    monkeypatch.setattr(interruption, "PATIENCE", 0.2)
    heard = []
    before = signal.signal(signal.SIGTERM, lambda number, frame: heard.append(number))
    with listening() as wish:
        wish.patient = True
        os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(0.5)
    signal.signal(signal.SIGTERM, before)
    assert not heard


def test_a_signal_while_a_checkpoint_is_written_is_not_lost(tmp_path, monkeypatch):
    """The run ends with the window after it."""
    save, saved = driver.Flight._save, []

    def asked_meanwhile(flight):
        save(flight)
        saved.append(flight.simulation.windows)
        if len(saved) == 2:
            os.kill(os.getpid(), signal.SIGTERM)

    monkeypatch.setattr(driver.Flight, "_save", asked_meanwhile)
    case = load("disc_cluster", "embedded", "run.checkpoint_windows=1")
    with pytest.raises(Stopped):
        driver.run(case, "disc_cluster", tmp_path / "run", None, Reporter(quiet=True))
    assert saved == [0, 1, 2]


def test_where_it_would_be_lost_it_comes_again():
    """What is raised in a callback of the compiler is lost."""

    def _raw_object_cache_notify():
        os.kill(os.getpid(), signal.SIGTERM)
        return "done"

    assert _raw_object_cache_notify.__name__ == interruption.CALLBACK
    with listening(), pytest.raises(Stopped):
        assert _raw_object_cache_notify() == "done"
        time.sleep(10.0 * interruption.LATER)
