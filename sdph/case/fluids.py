"""Properties of real fluids: `fluid = "..."` in [gas], [grains] (droplets), [liquid] or [gas_phase] fills what a case
leaves out, from CoolProp (Bell et al. 2014, Ind. Eng. Chem. Res. 53, 2498, and the sources that it names).

They are constants of a run, each at one temperature and at `gas.operating_pressure_Pa`: of the gas at its own; of
droplets at `grains.fluid_temperature_K`, the mean of those that regions and nozzles give them; of their vapour, and of
its diffusivity in the gas (Fuller), at that of the film, T_p + (T_g - T_p)/3 (the 1/3 rule: Hubbard, Denny & Mills
1975, Int. J. Heat Mass Transfer 18, 1003), all but without pressure; the latent heat at
`evaporation.latent_heat_temperature_K`, that at which droplets evaporate, their wet bulb in the gas at the start; of
[liquid] and [gas_phase] at `fluid_temperature_K`, that of the liquid's heat where it has one. Saturation is
Antoine's through three points from the droplets' temperature to boiling. Where the gas around droplets comes by name
too it is as in their film (`coupling.film`): else its conductivity would be that of a hotter gas than the vapour
diffuses in. What a case gives itself stands; the resolved case has every number.
"""

from __future__ import annotations

import math
import re
from statistics import fmean

import scipy

from sdph.case import properties
from sdph.laws import diffusion
from sdph.laws import evaporation as law
from sdph.laws.constants import GAS_CONSTANT
from sdph.schema import CaseError, unknown

AROMATIC = ("Benzene", "Toluene", "EthylBenzene", "m-Xylene", "o-Xylene", "p-Xylene")
ATMOSPHERE, ROOM = 101325.0, 293.15  # Pa, K: ISO 2533; ISO 1
BELOW = 1e-6  # of the boiling point: so near to it no wet bulb is told from it; our choice
THIN = 1.0  # Pa, at which a vapour is an ideal gas; our choice
HOW = "give the numbers in their place, or another fluid"
# key of a section -> what CoolProp calls it
OF_GAS = {"density_kg_m3": "D", "viscosity_Pa_s": "V", "conductivity_W_m_K": "L", "heat_capacity_J_kg_K": "C"}
OF_DROPLETS = {key: OF_GAS[key] for key in ("density_kg_m3", "heat_capacity_J_kg_K", "conductivity_W_m_K")}
OF_VAPOUR = {key: OF_GAS[key] for key in ("heat_capacity_J_kg_K", "conductivity_W_m_K", "viscosity_Pa_s")}
OF_PHASES = {key: OF_GAS[key] for key in ("density_kg_m3", "viscosity_Pa_s")}
OF_HEAT = {key: OF_GAS[key] for key in ("conductivity_W_m_K", "heat_capacity_J_kg_K")}
AT, AT_SURFACE = "fluid_temperature_K", "latent_heat_temperature_K"
LINEAR = "linear"  # of the laws of evaporation, the one that takes a film, and the default
MOLAR_MASS, TENSION, DIFFUSIVITY = "molar_mass_kg_kmol", "surface_tension_N_m", "diffusivity_m2_s"
# section with a fluid -> sections and the keys that it fills there, where the case has that effect
FILLS = {
    "gas": {"gas": (*OF_GAS, MOLAR_MASS)},
    "grains": {
        "grains": (*OF_DROPLETS, TENSION),
        "evaporation": ("latent_heat_J_kg", "saturation"),
        "vapour": (*OF_VAPOUR, MOLAR_MASS, DIFFUSIVITY),
    },
    "liquid": {
        "liquid": tuple(OF_PHASES), "surface_tension": ("coefficient_N_m",), "liquid_heat": tuple(OF_HEAT),
    },
    "gas_phase": {"gas_phase": tuple(OF_PHASES)},
}  # fmt: skip


class Fluid:
    """A pure fluid, or air, by the name in a case."""

    def __init__(self, name: str, where: str):
        try:
            self.library, self.where = properties.library(), where
            self.name = self.library.get_fluid_param_string(name, "name")
        except properties.Missing:
            raise CaseError(f"{where}.fluid = {name!r} needs CoolProp: pip install 'sdph[fluids]', or {HOW}") from None
        except (ValueError, RuntimeError):
            known = self.library.FluidsList()
            raise CaseError(f"{where}.fluid: {unknown(name, known).replace('unknown key', 'no fluid', 1)}") from None
        self.molar_mass = 1e3 * self.library.PropsSI("M", self.name)  # kg/kmol

    def at(self, what: str, of: str = "", **state: float) -> float:
        """A property [SI] at T [K] and P [Pa], or on the line of boiling at one of them and Q = 0 or 1; `of` says where
        T comes from."""
        low, high = (self.library.PropsSI(end, self.name) for end in ("Tmin", "Tmax"))
        if not low <= state.get("T", low) <= high:
            raise CaseError(
                f"{self.where}.fluid: {self.name} at {state['T']:g} K{of}; known from {low:g} to {high:g} K; {HOW}"
            )
        pairs = [part for pair in state.items() for part in pair]
        try:
            return float(self.library.PropsSI(what, *pairs, self.name))
        except ValueError as error:
            told = " ".join(f"{key} = {value:g}" for key, value in state.items())
            raise CaseError(f"{self.where}.fluid: {self.name} has no {what} at {told} ({error}); {HOW}") from None

    def latent_heat(self, temperature: float) -> float:
        """J/kg, of boiling at a temperature [K]."""
        return self.at("H", T=temperature, Q=1.0) - self.at("H", T=temperature, Q=0.0)

    def diffusion_volume(self) -> float:
        """cm3/mol, of Fuller's law."""
        if self.name in diffusion.MOLECULES:
            return diffusion.MOLECULES[self.name]
        atoms = re.findall(r"([A-Z][a-z]?)_\{(\d+)\}", self.library.get_fluid_param_string(self.name, "formula"))
        strange = [atom for atom, _ in atoms if atom not in diffusion.ATOMS]
        if strange or not atoms:
            raise CaseError(f"{self.where}.fluid: {self.name} has no diffusion volume; give vapour.diffusivity_m2_s")
        ring = diffusion.RING if self.name in AROMATIC else 0.0
        return sum(diffusion.ATOMS[atom] * int(number) for atom, number in atoms) - ring


def filled(table: dict) -> dict:
    """The table of a case with the numbers of its fluids; the same one where it names none."""
    own = table
    for name, fill in (("gas", _gas), ("grains", _droplets), ("liquid", _phase), ("gas_phase", _phase)):
        given = table.get(name)
        if isinstance(given, dict) and isinstance(given.get("fluid"), str) and given["fluid"] and _lacks(table, name):
            table = fill(table, name, Fluid(given["fluid"], name))
    return table if table is own else _with_film(own, table)


def rows(case) -> list[dict]:
    """Rows of `sdph explain`: each fluid that a case names, and the temperature of its numbers [K]."""
    told = []
    for name, own, at in (
        ("gas", case.gas, getattr(case.gas, "temperature", None)),
        *((name, own, getattr(own, "fluid_temperature", None)) for name, own in (
            ("grains", case.grains), ("liquid", case.liquid), ("gas_phase", case.gas_phase)
        )),
    ):  # fmt: skip
        if own is not None and own.fluid and at:
            told.append({"fluid": own.fluid, "of": f"[{name}]", "at [K]": at})
    boils = case.parameters.get("evaporation")
    if boils and boils.latent_heat_temperature:
        what = "its latent heat, at the wet bulb in the gas of the start"
        told.append({"fluid": case.grains.fluid, "of": what, "at [K]": boils.latent_heat_temperature})
    return told


def told(case) -> list[str]:
    """A line of a run for each of `rows`."""
    return [f"fluid {row['fluid']}: {row['of']} is that of {row['at [K]']:.6g} K" for row in rows(case)]


def _with_film(own: dict, table: dict) -> dict:
    """A filled `table` with the gas around droplets as in their film, where its conductivity and their vapour, which is
    that of the film, come by name, the law is one that takes a film, and the case `own` says nothing of it."""
    gas, grains, coupling, boils = (_section(own, name) for name in ("gas", "grains", "coupling", "evaporation"))
    by_name = gas.get("fluid") and grains.get("fluid") and "conductivity_W_m_K" not in gas
    asked = all(name in own.get("effects", ()) for name in ("evaporation", "heat"))
    if not by_name or not asked or boils.get("law", LINEAR) != LINEAR or "film" in coupling:
        return table
    return _with(table, "coupling", {"film": True})


def _section(table: dict, name: str) -> dict:
    """A section of the table of a case; empty where there is none."""
    return own if isinstance(own := table.get(name), dict) else {}


def _lacks(table: dict, name: str) -> bool:
    """True where a key is missing that a fluid fills: a resolved case needs no library."""
    on = {"vapour": "evaporation"}  # section -> effect that asks for it
    return any(
        key not in table.get(section, {})
        for section, keys in FILLS[name].items()
        if section == name or on.get(section, section) in table.get("effects", ())
        for key in keys
    )


def _with(table: dict, section: str, numbers: dict) -> dict:
    return table | {section: numbers | table.get(section, {})}


def _gas(table: dict, name: str, fluid: Fluid) -> dict:
    state = {"T": _number(table[name], "temperature_K", name), "P": _pressure(table)}
    numbers = {key: fluid.at(what, **state) for key, what in OF_GAS.items() if key not in table[name]}
    return _with(table, name, numbers | {MOLAR_MASS: fluid.molar_mass})


def _phase(table: dict, name: str, fluid: Fluid) -> dict:
    own, at = table[name], {AT: _temperature_of_liquid(table)} | table[name]
    state = {"T": _number(at, AT, name), "P": _pressure(table)}
    numbers = {key: fluid.at(what, **state) for key, what in OF_PHASES.items() if key not in own}
    table = _with(table, name, numbers | {AT: state["T"]})
    along = (
        ("surface_tension", {"coefficient_N_m": "I"}, {"T": state["T"], "Q": 0.0}),
        ("liquid_heat", OF_HEAT, state),
    )
    for effect, keys, at in along if name == "liquid" else ():
        if effect in table.get("effects", ()):
            given = _section(table, effect)
            own = {key: fluid.at(what, **at) for key, what in keys.items() if key not in given}
            table = _with(table, effect, own)
    return table


def _temperature_of_liquid(table: dict) -> float:
    """Temperature [K] of a liquid at the start: of its heat, else of its own numbers, else ROOM."""
    given = _section(table, "liquid_heat").get("temperature_K"), _section(table, "liquid").get(AT)
    return next((value for value in given if value is not None), ROOM)


def _droplets(table: dict, name: str, fluid: Fluid) -> dict:
    (cold, of), pressure = _of_droplets(table), _pressure(table)
    boiling = fluid.at("T", P=pressure, Q=0.0)
    if cold >= boiling:
        raise CaseError(
            f"{name}.fluid: droplets of {cold:g} K, but {fluid.name} boils at {boiling:g} K; make them colder"
        )
    own = table[name]
    numbers = {key: fluid.at(what, of, T=cold, P=pressure) for key, what in OF_DROPLETS.items() if key not in own}
    table = _with(table, name, numbers | {TENSION: fluid.at("I", of, T=cold, Q=0.0), AT: cold})
    if "evaporation" not in table.get("effects", ()):
        return table
    own, numbers = table.get("evaporation", {}), {}
    if "latent_heat_J_kg" not in own:
        surface = _number({AT_SURFACE: _wet_bulb(table, fluid, pressure)} | own, AT_SURFACE, "evaporation")
        numbers = {"latent_heat_J_kg": fluid.latent_heat(surface), AT_SURFACE: surface}
    if "saturation" not in own:
        points = cold, 0.5 * (cold + boiling), boiling
        pressures = [fluid.at("P", T=point, Q=0.0) for point in points]
        numbers |= {"saturation": "antoine", "antoine": list(law.antoine_through(points, pressures))}
    return _vapour(_with(table, "evaporation", numbers), fluid, cold, pressure)


def _vapour(table: dict, fluid: Fluid, cold: float, pressure: float) -> dict:
    """The same with the vapour of its droplets, at the temperature of the film."""
    own, gas = table.get("vapour", {}), table.get("gas", {})
    hot = _number(gas, "temperature_K", "gas")
    numbers = {key: _in_film(fluid, what, cold, hot) for key, what in OF_VAPOUR.items() if key not in own}
    if DIFFUSIVITY not in own:
        numbers[DIFFUSIVITY] = _diffusivity(gas, fluid, _film(cold, hot), pressure)
    return _with(table, "vapour", numbers | {MOLAR_MASS: fluid.molar_mass})


def _film(droplet: float, gas: float) -> float:
    """Temperature [K] of the gas around a droplet."""
    return droplet + (gas - droplet) / 3.0


def _in_film(fluid: Fluid, what: str, droplet: float, gas: float) -> float:
    """A property [SI] of the vapour of a fluid in the film."""
    of = f", in the film around a droplet of {droplet:g} K in gas.temperature_K = {gas:g}"
    return fluid.at(what, of, T=_film(droplet, gas), P=THIN)


def _diffusivity(gas: dict, fluid: Fluid, film: float, pressure: float) -> float:
    """m2/s, of the vapour of a fluid in the gas at the temperature of the film [K] (Fuller)."""
    around = Fluid(gas.get("fluid") or "Air", "gas")
    masses = fluid.molar_mass, gas.get(MOLAR_MASS, around.molar_mass)
    return diffusion.fuller(film, pressure, masses, (fluid.diffusion_volume(), around.diffusion_volume()))


def _wet_bulb(table: dict, fluid: Fluid, pressure: float) -> float:
    """Temperature [K] at which droplets of a fluid evaporate in the still gas of the start: that at which the heat
    that they get is what evaporation takes, with Stefan flow (`exact.spalding_wet_bulb`), vapour and gas as in the
    film; never below where the fluid freezes."""
    gas, own = _section(table, "gas"), _section(table, "vapour")
    hot, around = _number(gas, "temperature_K", "gas"), Fluid(gas.get("fluid") or "Air", "gas")
    dry = gas.get(MOLAR_MASS, around.molar_mass)
    given = own.get("mass_fraction", 0.0)
    boiling, freezing = fluid.at("T", P=pressure, Q=0.0), fluid.library.PropsSI("Tmin", fluid.name)

    def balance(T):
        film, latent = _film(T, hot), fluid.latent_heat(T)
        conductivity, capacity = around.at("L", T=film, P=pressure), _in_film(fluid, "C", T, hot)
        density = pressure * dry / (GAS_CONSTANT * film)
        surface = law.vapour_mass_fraction(fluid.at("P", T=T, Q=0.0) / pressure, fluid.molar_mass, dry)
        exponent = density * _diffusivity(gas, fluid, film, pressure) * capacity / conductivity
        mass, heat = law.spalding_number(surface, given), capacity * (hot - T) / latent
        return exponent * math.log1p(mass) - math.log1p(heat)

    low, high = freezing, min(hot, boiling * (1.0 - BELOW))
    if balance(low) >= 0.0 or high <= low:
        return low
    return scipy.optimize.brentq(balance, low, high) if balance(high) > 0.0 else high


def _of_droplets(table: dict) -> tuple[float, str]:
    """Temperature [K] that droplets have their numbers at, the mean of what regions and nozzles give them; and words
    on where it is from."""
    if AT in table["grains"]:
        return _number(table["grains"], AT, "grains"), f", grains.{AT}"
    given = {
        f"{group}.{name}": _number(entry, "temperature_K", f"{group}.{name}")
        for group in ("particles", "nozzles")
        for name, entry in table.get(group, {}).items()
        if isinstance(entry, dict) and "temperature_K" in entry
    }
    if not given:
        raise CaseError("grains.fluid: no region or nozzle gives temperature_K, at which its numbers are taken; add it")
    told = ", ".join(f"{name} {value:g} K" for name, value in given.items())
    return fmean(given.values()), f", the mean of temperature_K ({told})"


def _pressure(table: dict) -> float:
    return _number({"operating_pressure_Pa": ATMOSPHERE} | table.get("gas", {}), "operating_pressure_Pa", "gas")


def _number(section: dict, key: str, where: str) -> float:
    value = section.get(key)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise CaseError(f"{where}.{key} = {value!r}; the numbers of a fluid are taken there: give a number")
    return float(value)
