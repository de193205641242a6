"""The cloud of reactingParcelFoam as a case has it: forces, injectors, what patches do to droplets, heat and
evaporation; and `unlike`, what a case has that this cloud has not."""

from __future__ import annotations

from coupling.openfoam.comparators import droplet_sources, known
from coupling.openfoam.comparators.droplet_numbers import GAS_LAWS
from coupling.openfoam.comparators.droplet_sources import Injector
from sdph.case.sections import Case
from sdph.effects.around import sizes
from sdph.methods.grains.history import carried

CONTACT = ("granular_pressure", "granular_viscosity", "granular_temperature", "friction", "conduction")
# effects that the cloud has too, those that `unlike` tells of, and what is of particles as a method
KNOWN = frozenset((
    "inflow", "outflow", "gravity", "drag", "heat", "evaporation", "walls", *CONTACT,
    "gas_pressure", "artificial_viscosity", "grain_shifting",
))  # fmt: skip
SHAPES = ("slot", "disc", "cone")


def cloud(case: Case, injectors: list[Injector], patches: list[str], step: float, depth: float) -> str:
    """`constant/sdphCloud`; `patches` are all of the mesh but the sides of a plane one. It stands in another
    dictionary, and has no head."""
    forces = [word for effect, word in (("drag", "sphereDrag"), ("gravity", "gravity")) if effect in case.effects]
    entries = "".join(droplet_sources.entry(injector, step, depth) for injector in injectors)
    sides = "".join(f"        {name} {{ {_meeting(case, name)} }}\n" for name in patches)
    return (
        f"particleForces {{ {' '.join(f'{force};' for force in forces)} }}\n"
        f"injectionModels\n{{\n{entries}}}\n"
        f"localInteractionCoeffs\n{{\n    patches\n    (\n{sides}    );\n}}\n"
        f"heatTransferModel {'RanzMarshall' if 'heat' in case.effects else 'none'};\n"
        f"phaseChangeModel {'liquidEvaporation' if 'evaporation' in case.effects else 'none'};\n"
    )


def _meeting(case: Case, patch: str) -> str:
    """Fate of droplets at a patch: `walls` holds them everywhere but at an outlet of `outflow`; without
    `walls` they leave."""
    own = case.boundaries.get(patch)
    outlet = own is not None and own.lets_out and "outflow" in case.effects
    if outlet or "walls" not in case.effects:
        return "type escape;"
    return f"type rebound; e {case.parameters['walls'].restitution!r}; mu 0;"


def lacks(case: Case) -> list[str]:
    """Lines on what the droplets of OpenFOAM lack of a case."""
    if case.matters != ("grains",):
        return [f"its matter is {' and '.join(case.matters)}; the droplet reference has droplets in a gas"]
    if not {"evaporation", "inflow"} & set(case.effects):
        return ["effects holds neither evaporation nor inflow: its grains are no droplets; compare them --against tfm"]
    found = [*known.lacks(case, KNOWN, "the droplet reference"), *_of_gas(case)]
    for name, nozzle in case.nozzles.items():
        if nozzle.shape not in SHAPES:
            found.append(f"nozzles.{name}.shape = {nozzle.shape!r}; the droplet reference has {', '.join(SHAPES)}")
        if nozzle.rates:
            found.append(f"nozzles.{name}.rates; the droplet reference has one rate: give rate_kg_s to compare")
    return found


def _of_gas(case: Case) -> list[str]:
    """The same of its gas: that of the reference would be another."""
    gas = case.gas
    laws, outlets = ", ".join(GAS_LAWS), [b for b in case.boundaries.values() if b.kind == "pressure_outlet"]
    found = {
        f"gas.equation_of_state = {gas.equation_of_state!r}; the droplet reference has: {laws}":
            gas.equation_of_state not in GAS_LAWS,
        "gas.turbulence: the droplet reference is laminar": gas.turbulent,
        "domain.periodic: droplets come in again there, and in the droplet reference they do not": case.domain.periodic,
        "gravity in domain, none in effects: the droplet reference has it for gas and droplets alike":
            any(case.domain.gravity) and "gravity" not in case.effects,
        "no boundary is a pressure_outlet: the gas of the droplet reference has a density that no pressure changes, "
        "and vapour needs a way out": not outlets,
    }  # fmt: skip
    return [said for said, there in found.items() if there]


def unlike(case: Case) -> list[str]:
    """Lines, in plain words, of what the reference does otherwise than the case asks."""
    lines = ["OpenFOAM's gas does not know of the room that droplets take" + _own_room(case)]
    lines += _of_closures(case)
    if "evaporation" in case.effects:
        lines += _of_evaporation(case, case.parameters["evaporation"])
    if mixed := [name for name, nozzle in case.nozzles.items() if together(case, nozzle)]:
        lines.append(
            f"OpenFOAM's small and large droplets of {', '.join(mixed)} part in flight, those of the run fly together "
            f"in one particle of each class, unless there are more of these (size_classes={droplet_sources.PARTS})"
        )
    if not sized(case):
        lines.append("D32 is left out: no effect of the run follows the sizes of its droplets")
    if not {"outflow", "walls"} & set(case.effects):
        lines.append("OpenFOAM's droplets leave at every side, those of the run fly on outside of the gas (outflow)")
    lines += _of_walls(case)
    if "gas_pressure" in case.effects:
        lines.append("OpenFOAM's droplets do not feel the gradient of the gas's pressure, those of the run do")
    if touching := [name for name in CONTACT if name in case.effects]:
        lines.append(f"OpenFOAM's droplets pass through each other, those of the run have {', '.join(touching)}")
    return lines


def _of_walls(case: Case) -> list[str]:
    lines, own = [], case.parameters.get("walls")
    if own and own.friction:
        lines.append(f"OpenFOAM's droplets slide along walls freely, the run has walls.friction={own.friction:g}")
    if "drag" in case.effects and any(boundary.kind == "wall" for boundary in case.boundaries.values()):
        lines.append(
            "within a cell of a wall OpenFOAM's droplets feel gas that the wall slows (cellPoint), those of the run "
            "that of the cells around them: in a duct of few cells across OpenFOAM's lag behind"
        )
    return lines


def sized(case: Case) -> bool:
    """Tell whether the droplets of the run have sizes of their own."""
    return "diameter" in carried(case)


def _of_closures(case: Case) -> list[str]:
    lines, drag, heat = [], case.parameters.get("drag"), case.parameters.get("heat")
    if drag and drag.law != "putnam":
        lines.append(f"OpenFOAM's drag is that of one sphere (Putnam), the run's {drag.law}")
    if heat and heat.law != "ranz_marshall":
        lines.append(f"OpenFOAM's heat transfer is Ranz & Marshall's, the run's {heat.law}")
    if (drag or heat) and not case.coupling.film:
        lines.append(
            "OpenFOAM takes the gas around a droplet at (2 T_droplet + T_gas)/3, the run as it is (coupling.film=true)"
        )
    return lines


def together(case: Case, nozzle) -> bool:
    """Tell whether a nozzle gives droplets of several sizes, and these in one particle."""
    return len((own := sizes.of_nozzle(case, nozzle)).share) < droplet_sources.PARTS and bool(own.variance.any())


def _own_room(case: Case) -> str:
    return ", that of the run does (coupling.voidage=false)" if case.coupling.voidage else ", nor does the run's"


def _of_evaporation(case: Case, own) -> list[str]:
    lines = [
        "OpenFOAM's vapour spreads in the gas with Sc = 1, the run's with its diffusivity; in the film OpenFOAM's "
        "diffusivity goes as T^1.75 and is the case's where droplets come in"
    ]
    if own.law != "linear":
        lines.append(f"OpenFOAM's evaporation is linear in the vapour's concentration, the run's {own.law}")
    if own.onset == "latched" and own.onset_temperature:
        lines.append("OpenFOAM's droplets stop evaporating below the onset, those of the run go on once begun")
    return lines
