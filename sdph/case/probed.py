"""Fields that a probe can follow, and the names of their columns in history.csv."""

from __future__ import annotations

from sdph.case import bodies
from sdph.methods.grains.history import carried
from sdph.schema import CaseError

UNITS = {  # fields -> unit at the end of the column; "" of a number without one
    "pressure": "Pa", "velocity": "m_s", "temperature": "K", "density": "kg_m3", "alpha_p": "",
    "vapour_mass_fraction": "", "theta": "m2_s2", "diameter": "m", "displacement": "m", "equivalent_stress": "Pa",
    "plastic_strain": "", "damage": "", "level": "m",
}  # fmt: skip
VECTORS = ("velocity", "displacement")
OF_GAS = ("velocity", "pressure", "temperature", "density", "alpha_p")
OF_GRAINS = ("velocity", "density", "alpha_p", "temperature", "theta", "diameter")
OF_LIQUID = ("velocity", "pressure", "density", "level")
OF_SOLID = (*VECTORS, "equivalent_stress", "pressure", "density", "plastic_strain", "damage")


def fields(case, probe) -> dict[str, tuple[str, ...]]:
    """Fields that a probe follows, by whose they are: "particles", "gas"; without a choice the temperatures of grains
    and gas, of a liquid its pressure and velocity, of bodies displacement and velocity."""
    known = known_to(case, probe)
    usual = VECTORS[::-1] if of_body(case, probe) else ("pressure", "velocity") if case.liquid else ()
    usual = ("temperature",) if case.grains else usual
    chosen = probe.fields or usual
    return {whose: tuple(name for name in chosen if name in own) for whose, own in known.items()}


def of_body(case, probe) -> bool:
    """True of a probe that goes along with a body: of bodies alone all do, beside a liquid those that lie in one at the
    start."""
    return case.solid is not None and (case.liquid is None or bodies.around(case, probe.at) is not None)


def known_to(case, probe) -> dict[str, tuple[str, ...]]:
    """All fields that there are to follow for a probe of a case, by whose they are."""
    if not case.grains:
        return {"particles": OF_SOLID if of_body(case, probe) else OF_LIQUID}
    there = {"velocity", "density", "alpha_p", *carried(case)}
    gas = (*OF_GAS, "vapour_mass_fraction") if case.vapour else OF_GAS
    return {"particles": tuple(name for name in OF_GRAINS if name in there), "gas": gas}


def column(whose: str, field: str) -> str:
    """The end of a column's name; of a vector without its axis: velocity_m_s."""
    unit = UNITS[field]
    return ("gas_" if whose == "gas" else "") + field + (f"_{unit}" if unit else "")


def columns(case, probe) -> list[str]:
    """Ends of the names of all columns of a probe; of a vector one for each axis, velocity_x_m_s."""
    return [
        name
        for whose, own in fields(case, probe).items()
        for field in own
        for name in (by_axis(column(whose, field), case.dimensions) if field in VECTORS else [column(whose, field)])
    ]


def by_axis(name: str, dimensions: int) -> list[str]:
    """Columns of a vector: velocity_m_s is velocity_x_m_s, velocity_y_m_s, ..."""
    field = next(own for own in VECTORS if own in name)
    return [name.replace(f"{field}_", f"{field}_{a}_") for a in "xyz"[:dimensions]]


def check(case, where: str, probe) -> None:
    """`CaseError` where a field is not known in the case."""
    known = sorted({name for own in known_to(case, probe).values() for name in own})
    here = "at this place" if case.liquid and case.solid else "in this case"
    for name in probe.fields:
        if name not in known:
            raise CaseError(f"{where}.fields holds {name!r}; {here} there are: {', '.join(known)}")
