"""Drag of coarse cells: grains are pulled by the share that clusters leave, momentum closes, what it needs is said."""

import numpy as np
import pytest
from grain_boxes import DENSITY, VISCOSITY, Row, box, go, started, windows

from coupling.openfoam.comparators.two_fluid_numbers import macros
from sdph.cli import main
from sdph.effects.gas import drag
from sdph.laws import drag as law
from sdph.schema import CaseError

WIND, TIME, GRAVITY, DIAMETER = 0.3, 1e-4, (0.0, -9.81), 75e-6  # m/s, s, m/s2, m: fine grains make clusters


class Wind(Row):
    """Gas that blows along x."""

    def __init__(self, case, **kwargs):
        super().__init__(case, **kwargs)
        self.velocity[:, 0] = WIND


def pulled(folder, alpha_p=0.2, one_way=True, **own):
    sections = windows(TIME, 1)
    sections["coupling"] |= {"one_way": one_way}
    case = box(
        ["drag"],
        alpha_p=alpha_p,
        gravity=GRAVITY,
        drag={"law": "stokes"} | own,
        grains={"diameter_mm": 0.075},
        **sections,
    )
    return go(started(case, folder, Wind(case, alpha_g=None if not one_way else 1.0 - alpha_p)))


def rate(done) -> float:
    """1/s of the pull, from the velocity after the run."""
    return -np.log1p(-done.state.u.mean() / WIND) / TIME


@pytest.mark.parametrize("cells", [2.0, 0.5])
def test_grains_are_pulled_by_what_clusters_leave(tmp_path, cells):
    whole = rate(pulled(tmp_path))
    left = rate(pulled(tmp_path, filter="igci", filter_cells=cells))
    terminal = law.terminal_velocity(DIAMETER, DENSITY - 1.225, 1.225, VISCOSITY, 9.81)
    width = 9.81 * cells * 0.01 / terminal**2
    share = law.igci_filter(width) * law.igci_clusters(0.2)
    assert 0.1 < share < 0.9
    assert left == pytest.approx((1.0 - share) * whole, rel=1e-6)


def test_the_gas_loses_what_the_grains_gain(tmp_path):
    told = pulled(tmp_path, one_way=False, filter="igci").ledger.summary()
    assert told["exchange_momentum_mismatch_rel"] < 1e-12


def test_without_a_filter_there_is_none():
    assert drag.kernel(box(["drag"])).unresolved == 0.0


def test_it_goes_by_gravity():
    with pytest.raises(CaseError, match=r"drag.filter = .* give domain.gravity_m_s2"):
        drag.kernel(box(["drag"], drag={"filter": "igci"}))


def test_two_fluids_have_none():
    with pytest.raises(CaseError, match="the two-fluid reference has none"):
        macros(box(["drag"], gravity=GRAVITY, gas={"equation_of_state": "constant"}, drag={"filter": "igci"}))


def test_explain_says_how_wide_it_is(capsys):
    assert main(["explain", "bubbling_bed", "--set", "drag.filter=igci"]) == 0
    assert "filter g / v_t^2" in capsys.readouterr().out
    assert main(["explain", "bubbling_bed"]) == 0
    assert "filter" not in capsys.readouterr().out
