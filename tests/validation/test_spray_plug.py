"""Short form of `sdph validate spray_plug`: all of it with a coarser lattice, and an equation that fails where it is
off."""

import pytest

from sdph.laws import evaporation
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.study import compare, validate


def plug():
    return validate.part("spray_plug", "plug")


@pytest.mark.parametrize(("film", "law"), [(False, "schiller_naumann"), (True, "putnam")])
def test_plug_follows_its_equations(tmp_path, film, law):
    case = plug().case(film, law, spacing=25e-3)
    driver.run(case, "evaporating_jet", tmp_path / "run", None, Reporter(quiet=True))
    rows = plug().against("SDPH", plug().ours(compare.open_run(tmp_path / "run")), case)
    assert len(rows) == 5
    assert [row for row in rows if not row["ok"]] == []


@pytest.mark.openfoam
def test_droplet_solver_follows_the_equations_of_the_film(tmp_path):
    """And not those of the gas as it is: more than the bar lies between them."""
    case = plug().case(True, "putnam")
    values = plug().droplets(case, tmp_path / "dpm")
    assert [row for row in plug().against("droplets", values, case) if not row["ok"]] == []
    bare = plug().case(False, "putnam")
    assert sum(not row["ok"] for row in plug().against("droplets", values, bare)) >= 3


def test_equations_in_gas_full_of_vapour_are_those_of_two_temperatures():
    """Where surface and gas hold the same vapour nothing evaporates, and at rest Nu = 2: by hand."""
    case = plug().case(False, "stokes")
    mole = 1329.0 * 350.0 / (294.0 * case.gas.operating_pressure)
    full = evaporation.vapour_mass_fraction(mole, case.vapour.molar_mass, case.gas.molar_mass)
    rates = plug().change(case, 0.0, [0.0, 294.0, 350.0, full, case.grains.diameter**2])
    warming = 12.0 * 0.0242 / 0.3e-3**2 * 56.0 / (700.0 * 2470.0)  # 6 Nu k/d^2 (T_g - T_p)/(rho c)
    mixture = 1.225 * (1006.43 + full * (2470.0 - 1006.43))
    cooling = warming * plug().ALPHA_P * 700.0 * 2470.0 / mixture
    assert rates == pytest.approx(
        [0.0, warming, -cooling, 0.0, 0.0], rel=1e-7, abs=1e-15
    )  # root of a slip of round-off
