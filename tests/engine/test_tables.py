"""Tables that a run writes row by row."""

import pytest

from sdph.engine.table import Table
from sdph.schema import CaseError


def test_a_row_of_another_build_is_refused_by_its_column(tmp_path):
    """A file that goes on has the columns of who began it."""
    table = Table(tmp_path / "history.csv")
    table.write({"time_s": 0.0, "mass_kg": 1.0})
    with pytest.raises(CaseError, match=r"history.csv has no column gas_new_rel: another build of sdph began it"):
        table.write({"time_s": 1.0, "mass_kg": 1.0, "gas_new_rel": 0.0})
    table.write({"time_s": 1.0, "mass_kg": 1.0})
    table.close()
    assert (tmp_path / "history.csv").read_text().split() == ["time_s,mass_kg", "0.0,1.0", "1.0,1.0"]
