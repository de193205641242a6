"""What is set before kernels are compiled, and what is said of how they ran."""

import os

import numba
import pytest

from sdph import environment


@pytest.mark.parametrize(("layer", "count"), [("omp", 0), ("workqueue", 1)])
def test_the_work_queue_is_told(monkeypatch, layer, count):
    monkeypatch.setattr(numba, "threading_layer", lambda: layer)
    assert len(environment.warnings()) == count


def test_before_any_parallel_loop_there_is_nothing_to_tell(monkeypatch):
    def unknown():
        raise ValueError("Threading layer is not initialized.")

    monkeypatch.setattr(numba, "threading_layer", unknown)
    assert environment.warnings() == []


def test_what_the_user_has_set_stays(monkeypatch):
    monkeypatch.setenv("NUMBA_CPU_FEATURES", "+sse2")
    monkeypatch.setenv("NUMBA_THREADING_LAYER_PRIORITY", "workqueue")
    environment.prepare()
    assert (os.environ["NUMBA_CPU_FEATURES"], os.environ["NUMBA_THREADING_LAYER_PRIORITY"]) == ("+sse2", "workqueue")


def test_an_edited_law_gets_kernels_of_its_own(monkeypatch, tmp_path):
    """numba itself does not notice that a callee in another file was edited."""
    package = tmp_path / "sdph"
    package.mkdir()
    (package / "law.py").write_text("@law\ndef drag(): return 1\n")
    monkeypatch.setattr(environment, "__file__", str(package / "environment.py"))
    before = environment._sources()
    (package / "law.py").write_text("@law\ndef drag(): return 2\n")
    assert environment._sources() != before
