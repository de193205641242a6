"""Balance of mass and heat of a lone drop, written down apart from the code: what of a rate is the model's.

With AS_RUN it is the model as runs by Spalding's law have it (`lone_drops`): constants of the start, Spalding's flux,
heat Nu k (T_g - T)/d, of which the flow of the vapour lets x/(exp(x) - 1) through, x = m' cp_v/(Nu pi d k) (Spalding
1953, 4th Symp. (Int.) Combust., 847): that is STEFAN of what `more` may name. The others are LATENT, the latent heat at
the drop's temperature; LIQUID, its density and heat capacity there; GAS, diffusivity and numbers of the gas at the film
of the moment.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp

from sdph.case.fluids import Fluid
from sdph.effects.gas import film
from sdph.laws import diffusion, evaporation, heat

from .lone_drops import Drop

STEFAN, LATENT, LIQUID, GAS = WHOLE = ("stefan", "latent", "liquid", "gas")
AS_RUN = (STEFAN,)
NEAREST = 0.1  # K from boiling, where a drop is held, and from freezing; our choice
LEFT = 0.02  # of the mass, at which a course ends


class _Numbers:
    """Numbers of a drop at its temperature, from tables over it: a constant one is its value at the start."""

    def __init__(self, drop: Drop, more):
        self.drop, self.more, p = drop, more, drop.pressure
        own, gas = Fluid(drop.liquid, "balance"), Fluid(drop.gas, "balance")
        masses, volumes = (own.molar_mass, gas.molar_mass), (own.diffusion_volume(), gas.diffusion_volume())
        self.masses, self.most = masses, own.at("T", P=p, Q=0.0) - NEAREST
        self.places = np.linspace(own.library.PropsSI("Tmin", own.name) + NEAREST, self.most, 200)
        around = film.temperature(drop.hot, self.places)
        of_drop = lambda law: [law(T) for T in self.places]  # noqa: E731
        of_film = lambda law: [law(T) for T in around]  # noqa: E731
        self.tables = {
            "saturation": (None, of_drop(lambda T: own.at("P", T=T, Q=0.0))),
            "latent": (LATENT, of_drop(own.latent_heat)),
            "density": (LIQUID, of_drop(lambda T: own.at("D", T=T, P=p))),
            "capacity": (LIQUID, of_drop(lambda T: own.at("C", T=T, P=p))),
            "vapour": (GAS, of_film(lambda T: own.at("C", T=T, P=1.0))),
            "diffusivity": (GAS, of_film(lambda T: diffusion.fuller(T, p, masses, volumes))),
            **{key: (GAS, of_film(lambda T, key=key: gas.at(key, T=T, P=p))) for key in "DVLC"},
        }

    def __call__(self, name: str, temperature: float) -> float:
        part, values = self.tables[name]
        moving = part is None or part in self.more
        return float(np.interp(temperature if moving else self.drop.cold, self.places, values))

    def diameter(self, mass: float, temperature: float) -> float:
        return (6.0 * mass / (math.pi * self("density", temperature))) ** (1.0 / 3.0)


def course(drop: Drop, more=AS_RUN) -> np.ndarray:
    """Times [s], squares of the diameter over the first, temperatures [K], until all but LEFT of the mass is gone."""
    numbers = _Numbers(drop, more)
    first = math.pi / 6.0 * drop.diameter**3 * numbers("density", drop.cold)
    gone = lambda _, y: y[0] - LEFT * first  # noqa: E731
    gone.terminal = True
    found = solve_ivp(
        lambda _, y: _rates(numbers, *y), (0.0, 10.0 * drop.time), (first, drop.cold), events=gone, rtol=1e-6,
        atol=(1e-8 * first, 1e-5), max_step=drop.time / 200.0,
    )  # fmt: skip
    diameters = np.array([numbers.diameter(*y) for y in found.y.T])
    return np.array([found.t, (diameters / drop.diameter) ** 2, found.y[1]])


def _rates(of: _Numbers, mass: float, temperature: float) -> tuple[float, float]:
    """dm/dt [kg/s] and dT/dt [K/s]."""
    drop, T = of.drop, min(temperature, of.most)
    d, rho, mu, k, D = of.diameter(mass, T), of("D", T), of("V", T), of("L", T), of("diffusivity", T)
    reynolds = rho * drop.speed * d / mu
    sherwood = evaporation.sherwood_ranz_marshall(reynolds, evaporation.schmidt_number(rho, mu, D))
    nusselt = heat.ranz_marshall(1.0, reynolds, heat.prandtl_number(mu, of("C", T), k))
    at_surface = evaporation.vapour_mass_fraction(of("saturation", T) / drop.pressure, *of.masses)
    lost = math.pi * d * sherwood * D * evaporation.driving_force_spalding(at_surface, drop.humidity, rho)
    conductance = math.pi * d * nusselt * k
    against = lost * of("vapour", T) / conductance
    share = against / math.expm1(against) if STEFAN in of.more and against else 1.0
    gained = share * conductance * (drop.hot - T) - lost * of("latent", T)
    return -lost, gained / (mass * of("capacity", T))
