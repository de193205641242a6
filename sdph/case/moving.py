"""Translation of a case that was written for the weakly compressible method: `--set method.name=mps`.

What smooths a pressure that an equation of state gives has no place where the pressure solves an equation of its own. A
second phase that is a gas is left out, and tension is that of the free energy. All that is left out is named in
`method.left_out`, and a run tells it.
"""

from __future__ import annotations

from sdph.methods.liquids.sections import Liquid
from sdph.schema import defaults

NUMERICAL = ("density_diffusion", "liquid_damping", "shifting", "xsph")
# keys of [liquid] that the equation of state or a kernel has, and their defaults
OF_SOUND = {
    key: default for key, default in defaults(Liquid).items()
    if key in ("sound_speed_m_s", "exponent", "background_pressure_Pa", "kernel", "pressure_gradient", "courant")
}  # fmt: skip
DROPS = {"reach": 3.1}, {"reach": 4.1}  # r_e, r_t in two dimensions: swirl-sheet.md, section 3


def taken_over(table: dict) -> dict:
    """The table of a case with a liquid; the same one where nothing has to be left out."""
    method, on = table.get("method"), table.get("effects")
    if not isinstance(method, dict) or method.get("name") != "mps" or not isinstance(on, list):
        return table
    gas = [name for name, pool in _named(table.get("pools")) if pool.get("phase") == "gas"]
    tension = "surface_tension" in on and "free_energy_tension" not in on
    left = [name for name in on if name in NUMERICAL or (name == "surface_tension" and tension)]
    left += [f"pools.{name}" for name in gas] + ["gas_phase"] * ("gas_phase" in table)
    idle = _of_sound(table.get("liquid"))
    left += [f"liquid.{key}" for key in idle]
    left += ["liquid.periodic"] * bool(gas and table.get("liquid", {}).get("periodic"))
    if not left:
        return table
    tensed = table.get("surface_tension", {})
    table = {key: value for key, value in table.items() if key not in left}
    table["effects"] = [name for name in on if name not in left] + ["free_energy_tension"] * tension
    table["method"] = method | {"left_out": left}
    if gas:
        table["pools"] = {name: pool for name, pool in table["pools"].items() if name not in gas}
        idle = [*idle, "periodic"]
    if idle:
        table["liquid"] = {key: value for key, value in table["liquid"].items() if key not in idle}
    return _with_tension(table, tensed) if tension else table


def _of_sound(liquid) -> list[str]:
    """Keys of [liquid] that OF_SOUND has, given with another value than their default."""
    given = liquid if isinstance(liquid, dict) else {}
    return [key for key, default in OF_SOUND.items() if key in given and given[key] != default]


def _with_tension(table: dict, given) -> dict:
    """The same with the coefficient of `surface_tension`, and in two dimensions the reaches of drops."""
    reaches = DROPS if table.get("dimensions") == 2 else ({}, {})
    own = {key: value for key, value in given.items() if key == "coefficient_N_m"} if isinstance(given, dict) else {}
    return table | {"method": reaches[0] | table["method"], "free_energy_tension": reaches[1] | own}


def _named(group) -> list:
    """(name, entry) of a group of named sections."""
    entries = group.items() if isinstance(group, dict) else ()
    return [(name, entry) for name, entry in entries if isinstance(entry, dict)]
