"""Several materials of grains in one case: `[grains.sand]`, `[grains.char]`, ... in place of `[grains]`.

One rule: a key of `[grains]` beside them holds for every material, and a material's own key goes before it. What is of
the bed as a whole (BED) stands in `[grains]` alone.
"""

from __future__ import annotations

from sdph.case.matter import Grains
from sdph.effects.around.sizes import OF_LAW
from sdph.schema import CaseError, fields, plausible, read, unknown, write

BED = ("restitution", "packing_limit", "granular_temperature_m2_s2")  # one for all, as friction and drag are
OF_DROPS = ("fluid", "surface_tension_N_m")
MOST = 100  # materials: their numbers are bytes in the State; our choice
# effects that know one material, and why
STRANGE = {
    "evaporation": "vapour is of one species", "micro_explosion": "droplets are of one fuel",
    "break_up": "droplets are of one liquid", "reaction": "all grains would burn",
    "turbulent_dispersion": "grains fall through its eddies at one speed",
}  # fmt: skip
METRICS = ("column", "jet", "bursts")  # that compare with formulas of one material
INSTEAD = {"column": "; a pressure drop is the difference of two rows of gas_pressure_Pa of a [profiles.NAME] along it"}


def named(table: dict) -> dict[str, dict]:
    """Sections of the materials in the table of a case, by name; none where [grains] is one without a name."""
    given = table.get("grains")
    return {key: own for key, own in given.items() if isinstance(own, dict)} if isinstance(given, dict) else {}


def materials(table: dict) -> dict[str, Grains]:
    """Materials by name from the table of a case; none where [grains] is one without a name."""
    own, known = named(table), fields(Grains)
    common = {key: value for key, value in table["grains"].items() if key not in own} if own else {}
    if own and (strange := [key for key in common if key not in known]):
        raise CaseError(unknown(f"grains.{strange[0]}", known, "grains"))
    if len(own) > MOST:
        raise CaseError(f"[grains] holds {len(own)} materials; {MOST} are allowed: leave some out")
    return {name: _material(name, given, common, known) for name, given in own.items()}


def _material(name: str, given: dict, common: dict, known) -> Grains:
    where = f"grains.{name}"
    if name in known:
        raise CaseError(f"{where} is a section; it must be a value, or name the material otherwise")
    if not name.isidentifier():
        raise CaseError(f"[{where}]: a material is a word of letters, digits and _, as its name heads columns")
    for key in OF_DROPS:
        if key in given:
            raise CaseError(
                f"{where}.{key} is of droplets, which are of one material: evaporation and vapour know no second one; "
                f"give {key} in [grains], without [{where}] and its like, or leave it out"
            )
    for key in BED:
        if key in given:
            raise CaseError(f"{where}.{key} is of all grains together; give it in [grains]")
    return plausible(read(Grains, common | given, where), where)


def tables(case) -> dict:
    """The [grains] of a case as TOML: one section, or what is common and a section for each material."""
    if not case.materials:
        return write(case.grains)
    each = {name: write(own) for name, own in case.materials.items()}
    shared = (*BED, *OF_DROPS)
    common = {key: value for key, value in write(case.grains).items() if key in shared and value != ""}
    return common | {name: {k: v for k, v in own.items() if k not in shared} for name, own in each.items()}


def check(case) -> None:
    """CaseError where grains do not say which material they are, or something knows only one."""
    for group, parts in (("particles", case.particles), ("nozzles", case.nozzles)):
        for name, part in parts.items():
            _check_name(case, f"{group}.{name}", part.material)
    filtered = "drag" in case.effects and case.parameters["drag"].filter != "none"
    for name, nozzle in case.nozzles.items() if filtered else ():
        if own := [key for key in OF_LAW if getattr(nozzle, key)]:
            raise CaseError(
                f"drag.filter goes by the speed at which grains of one size fall, and nozzles.{name} has its own ("
                f"{', '.join(own)}): leave one of the two out"
            )
    if not case.mixed:
        return
    several = f"the grains are of several materials ({', '.join(case.materials)})"
    for name, why in STRANGE.items():
        if name in case.effects:
            raise CaseError(f"effects holds {name}, and {several}: {why}; leave it out, or all materials but one")
    if filtered:
        raise CaseError(f"drag.filter goes by the speed at which one material falls, and {several}: leave it out")
    for key in OF_DROPS:
        if write(case.grains).get(key):
            raise CaseError(f"grains.{key} is of droplets, and {several}: leave it out")
    for name in METRICS:
        if name in case.run.metrics:
            raise CaseError(
                f"run.metrics holds {name}, which compares with formulas of one, and {several}: leave it out"
                f"{INSTEAD.get(name, '')}"
            )
    for name, nozzle in case.nozzles.items():
        if nozzle.shape == "table":
            raise CaseError(
                f"nozzles.{name}.shape = 'table' has drops of one material, and {several}; take another shape"
            )
    if case.liquid:
        raise CaseError(
            f"{several[:1].upper()}{several[1:]} beside a liquid: that is not known here; give one material"
        )


def _check_name(case, where: str, given: str) -> None:
    if given and given not in case.materials:
        if not case.materials:
            raise CaseError(
                f"{where}.material = {given!r}, and [grains] is one material without a name; leave it out, or name it: "
                f"[grains.{given}]"
            )
        raise CaseError(f"{where}.material: {unknown(given, case.materials).replace('unknown key', 'no material', 1)}")
    if not given and case.mixed:
        raise CaseError(f"{where}.material is missing; the case has several: {', '.join(case.materials)}: name one")
