"""Short forms of the scenes' own comparisons with closed forms."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.study import compare

SHORT = {
    "single_droplet": (),
    "stefan_tube": ("run.end_time_s=70.0", "run.output_interval_s=70.0"),
}


@pytest.mark.parametrize("name", SHORT)
def test_closed_form(tmp_path, name):
    case = cases.load(scenes.find(name)[1], ("coupling.gas='embedded'", *SHORT[name]))
    driver.run(case, name, tmp_path / "run", None, Reporter(quiet=True))
    failed = [check for check in compare.compare(tmp_path / "run", "exact") if not check["ok"]]
    assert not failed
