"""The film of gas around a droplet: laws at its own properties, nothing when off, and what it does not go with."""

import dataclasses

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.gas import evaporation, film
from sdph.laws import drag
from sdph.laws import evaporation as law
from sdph.schema import CaseError

DROPLET = "coupling.film=true", "evaporation.law='linear'"


def droplet(*overrides):
    return cases.load(scenes.find("single_droplet")[1], overrides)


def test_film_is_a_third_of_the_way_to_the_gas():
    """Hubbard, Denny & Mills 1975: (2 * 294 + 350)/3 by hand."""
    assert film.temperature(350.0, 294.0) == pytest.approx(312.6666667, rel=1e-9)


@pytest.mark.parametrize("chosen", [drag.schiller_naumann, drag.putnam, drag.gidaspow])
def test_density_by_the_square_of_r_gives_the_law_of_the_film(chosen):
    r, rho, mu = 350.0 / 312.67, 1.225, 1.8e-5
    own = chosen(0.01, 5.0, 3e-4, rho * r, mu / r)
    assert chosen(0.01, 5.0, 3e-4, rho * r**2, mu) / r == pytest.approx(own, rel=1e-13)


def test_vapour_of_surface_and_gas_is_counted_at_the_film():
    p = evaporation.kernel(droplet(*DROPLET, "evaporation.saturation='constant'"))
    around, gas = film.temperature(350.0, 294.0), 2e-5
    pressure = law.partial_pressure(gas, 350.0)
    expected = p.molar_mass * law.vapour_concentration(1329.0 - pressure, around)
    assert evaporation.driving_force(p, 294.0, gas, 350.0, 1.2) == pytest.approx(expected, rel=1e-12)


def test_droplet_in_gas_that_holds_all_it_can_gives_nothing():
    for overrides in (DROPLET, ()):
        p = evaporation.kernel(droplet(*overrides))
        full = evaporation.saturated(p, 294.0, 350.0)
        assert abs(evaporation.driving_force(p, 294.0, full, 350.0, 1.2)) < 1e-12


def test_a_film_that_is_off_has_no_parameters():
    assert film.kernel(droplet()) == ()


def test_a_film_without_heat_and_with_spaldings_law_is_refused():
    cold = dataclasses.replace(droplet("coupling.film=true"), effects=("evaporation",))
    with pytest.raises(CaseError, match="add heat"):
        film.kernel(cold)
    with pytest.raises(CaseError, match="take 'linear'"):
        evaporation.kernel(droplet("evaporation.law='spalding'", "coupling.film=true"))


def test_film_of_many_droplets_at_once():
    assert np.allclose(film.temperature(np.array([350.0, 300.0]), np.array([290.0, 300.0])), [310.0, 300.0])
