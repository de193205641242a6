"""Properties of gas and grains, gravity and times of an OpenFOAM case, as keys of case.toml."""

from __future__ import annotations

import numpy as np

from coupling.openfoam.dictionary import number, vector, word
from coupling.openfoam.foreign.files import Files, density
from sdph.laws.constants import GAS_CONSTANT
from sdph.schema import CaseError

AIR = {
    "density_kg_m3": 1.225,
    "viscosity_Pa_s": 1.7895e-5,
    "conductivity_W_m_K": 0.0242,
    "heat_capacity_J_kg_K": 1006.43,
    "temperature_K": 288.15,
}  # fmt: skip  (ISO 2533, at sea level)
MOLAR_MASS = 28.96  # kg/kmol of dry air, ISO 2533
GLASS = {"density_kg_m3": 2500.0, "diameter_mm": 0.5, "heat_capacity_J_kg_K": 840.0, "conductivity_W_m_K": 1.0}
DRAG = {"GidaspowErgunWenYu": "gidaspow_switch", "Ergun": "ergun", "WenYu": "wen_yu", "SyamlalOBrien": "syamlal_obrien",
        "SchillerNaumann": "schiller_naumann", "Beetstra": "beetstra"}  # fmt: skip
# equations of state of OpenFOAM that are of liquids
LIQUID = ("adiabaticPerfectFluid", "Boussinesq", "icoPolynomial", "perfectFluid", "rPolynomial")
STEADY = ("simpleFoam", "rhoSimpleFoam", "potentialFoam", "porousSimpleFoam", "buoyantSimpleFoam")
BY_TIME = ("runTime", "adjustableRunTime", "adjustable")  # kinds of writeControl that count seconds
ABSOLUTE = 1e4  # Pa, from which on a pressure is taken for an absolute one; our choice
KINEMATIC = (0.0, 2.0, -2.0)  # dimensions of a pressure over the density


def gas(files: Files, notes: list[str]) -> dict:
    """[gas]; what the case does not tell is that of air, and told."""
    own = files.of_phase(files.phase)
    mixture = own.get("mixture", own)
    part = {name: mixture.get(name, {}) for name in ("specie", "thermodynamics", "transport")}
    mass, cp = number(part["specie"].get("molWeight")), number(part["thermodynamics"].get("Cp"))
    inside = files.inside("T")
    found = {"temperature_K": None if inside is None else float(inside.mean()), "heat_capacity_J_kg_K": cp}
    if inside is not None and np.ptp(inside):
        notes.append("gas: T is uneven at the start: temperature_K is the mean of its cells")
    if cp is None and (cv := number(part["thermodynamics"].get("Cv"))):
        found["heat_capacity_J_kg_K"] = cv + GAS_CONSTANT / (mass or MOLAR_MASS)
    found["density_kg_m3"] = density(own) or number(mixture.get("rho"))
    state = word(own.get("thermoType", {}).get("equationOfState"))
    found["viscosity_Pa_s"] = number(part["transport"].get("mu"))
    temperature = found["temperature_K"] or AIR["temperature_K"]
    if found["density_kg_m3"] is None and mass:
        found["density_kg_m3"] = level(files)["operating"] * mass / (GAS_CONSTANT * temperature)
    if found["viscosity_Pa_s"] is None and (nu := number(own.get("nu"))):
        found["viscosity_Pa_s"] = nu * (found["density_kg_m3"] or AIR["density_kg_m3"])
    prandtl = number(part["transport"].get("Pr"))
    if prandtl and found["viscosity_Pa_s"]:
        known = found["heat_capacity_J_kg_K"] or AIR["heat_capacity_J_kg_K"]
        found["conductivity_W_m_K"] = found["viscosity_Pa_s"] * known / prandtl
    whole = {"equation_of_state": "operating" if state == "perfectGas" else "constant"} | _filled(
        found, AIR, "gas", notes
    )
    if whole["equation_of_state"] == "operating":
        whole |= {"molar_mass_kg_kmol": mass or MOLAR_MASS, "operating_pressure_Pa": level(files)["operating"]}
        notes.append("gas: perfectGas is taken as ideal gas at the operating pressure, the mean of p (no sound waves)")
    elif state not in ("", "rhoConst", "perfectGas"):
        notes.append(f"gas: {state} is not known; density_kg_m3 is constant")
    return whole


def grains(files: Files, notes: list[str]) -> dict:
    """[grains]; glass beads where the case has none."""
    if not files.grains:
        notes.append("the case has no phase of grains: glass beads of 0.5 mm stand in [grains]; put yours there")
        return dict(GLASS)
    own, phase = files.of_phase(files.grains), files.phases.get(files.grains, {})
    state = word(own.get("thermoType", {}).get("equationOfState"))
    if state in LIQUID:
        raise CaseError(
            f"{files.folder}: its phases are {files.phase}, a gas, and {files.grains}, a liquid ({state}): no grains "
            "to import; `sdph list` has scenes of liquids with a gas"
        )
    mixture, model = own.get("mixture", {}), word(phase.get("diameterModel"))
    size = number(phase.get(f"{model}Coeffs", phase).get("d") or phase.get("d"))
    found = {"density_kg_m3": density(own), "diameter_mm": size and 1e3 * size,
             "heat_capacity_J_kg_K": number(mixture.get("thermodynamics", {}).get("Cp"))}  # fmt: skip
    whole = _filled(found, GLASS, "grains", notes)
    theory = _theory(files)
    if (limit := number(phase.get("alphaMax"))) and limit <= 0.74:
        whole["packing_limit"] = limit
    if (bounce := number(theory.get("kineticTheoryCoeffs", {}).get("e"))) is not None:
        whole["restitution"] = min(bounce, 0.9999)
    return whole


def _theory(files: Files) -> dict:
    """Entries of the turbulence model of the grains."""
    own = files.first(f"constant/turbulenceProperties.{files.grains}", f"constant/momentumTransport.{files.grains}")
    return own.get("RAS", own)


def friction_angle(files: Files) -> float | None:
    """[deg] of the model of friction."""
    own = _theory(files).get("kineticTheoryCoeffs", {})
    model = own.get(f"{word(own.get('frictionalStressModel'))}Coeffs", {})
    return number(model.get("phi")) if files.grains else None


def drag(files: Files, notes: list[str]) -> str:
    """Law of [drag]; empty where the case names none that is known."""
    given = files.phases.get("drag", {})
    entries = [e for e in given.values() if isinstance(e, dict)] if isinstance(given, dict) else []
    models = [word(entry.get("type")) for entry in entries] or _listed(given)
    law = DRAG.get(models[0], "") if models else ""
    if models and not law:
        notes.append(f"drag: {models[0]} is not known; drag.law is the default")
    return law


def _listed(given) -> list[str]:
    """Types in the older form, drag ( (a in b) { type X; } )."""
    rows = given[0] if isinstance(given, list) and given and isinstance(given[0], list) else []
    return [word(row.get("type")) for row in rows if isinstance(row, dict)]


def gravity(files: Files, dimensions: int, notes: list[str]) -> list[float]:
    """[m/s2]; none where the case has no constant/g."""
    found = vector(files.read("constant/g").get("value"))
    if found is None:
        notes.append("the case has no constant/g: no gravity")
    return (found or [0.0] * 3)[:dimensions]


def times(files: Files, notes: list[str]) -> tuple[float, float]:
    """End of the run and interval of its outputs [s]."""
    control, steady = files.control, word(files.control.get("application")) in STEADY
    begin, end = (number(control.get(name)) for name in ("startTime", "endTime"))
    if steady or not end or end <= (begin or 0.0):
        notes.append("system/controlDict tells of no span of time: run.end_time_s = 1")
        return 1.0, 0.1
    span, interval = end - (begin or 0.0), number(control.get("writeInterval")) or 0.0
    if word(control.get("writeControl")) not in BY_TIME:
        interval *= number(control.get("deltaT")) or 0.0
    return span, min(max(interval, 1e-3 * span), span) if interval else 0.1 * span


def level(files: Files) -> dict[str, float]:
    """`operating` [Pa], the absolute pressure of the case where it is one, and `factor` that makes its pressures Pa."""
    field = files.field("p_rgh") or files.field("p")
    inside, exponents = files.inside("p_rgh", "p"), (field.get("dimensions") or [()])[0]
    mean = 0.0 if inside is None else float(inside.mean())
    kinematic = tuple(exponents)[:3] == KINEMATIC
    return {"operating": mean if mean > ABSOLUTE else 101325.0,
            "factor": (density(files.of_phase(files.phase)) or AIR["density_kg_m3"]) if kinematic else 1.0}  # fmt: skip


def turbulence(files: Files, notes: list[str]) -> None:
    """Tell that a model of turbulence is left out."""
    own = files.first(*(f"constant/{name}{end}" for end in (f".{files.phase}", "")
                        for name in ("turbulenceProperties", "momentumTransport")))  # fmt: skip
    kind = word(own.get("simulationType"))
    if kind not in ("", "laminar"):
        notes.append(f"turbulence ({kind}) is left out: give [gas.turbulence] where the gas is to have it")


def _filled(found: dict, defaults: dict, section: str, notes: list[str]) -> dict:
    """Values found that are above 0; others from `defaults`, and told."""
    lacking = [name for name in defaults if not (found.get(name) or 0.0) > 0.0]
    if lacking:
        given = ", ".join(f"{name} = {defaults[name]:g}" for name in lacking)
        notes.append(f"{section}: the case does not tell {given}: our choice")
    return {name: defaults[name] if name in lacking else found[name] for name in defaults}
