"""Keys of a gel droplet, `sdph droplet FILE --set section.key=value`: sections of a TOML file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from sdph.case import read as cases
from sdph.case import usual
from sdph.case.ranges import OF_DROPLET
from sdph.effects.gas import gel
from sdph.schema import CaseError, choice, plausible, quantity, read, record, unknown, whole, write


@record
class Drop:
    """Size and place. Defaults: the base case of gel-droplet.md; the paper's 10 MPa is above the critical pressure."""

    dimensions: int = whole(2, least=2)  # 2: a cylinder, by the metre; 3: a sphere
    diameter: float = quantity("mm", 1.0, above=0.0)
    shell_thickness: float = quantity("um", 50.0, above=0.0)
    bubble_diameter: float = quantity("mm", 0.3, above=0.0)
    ambient_pressure: float = quantity("Pa", 101325.0, above=0.0)
    surface_tension: float = quantity("N_m", 0.025, least=0.0)


@record
class Gel:
    """Gel, and the heat of its shell: table 2 of Qiang et al. 2017."""

    density: float = quantity("kg_m3", 1500.0, above=0.0)
    heat_capacity: float = quantity("J_kg_K", 5000.0, above=0.0)
    conductivity: float = quantity("W_m_K", 0.5, above=0.0)


@record
class Heating:
    """Heat: flux times the first surface, constant. 1.42e5 W/m2 swells the base case to 1.4 at the paper's 0.75 s."""

    flux: float = quantity("W_m2", 1.42e5, above=0.0)
    place: str = choice("rim", "inside")


@record
class Vent:
    """Tear: a slit of this width (a hole of this diameter in a sphere), and how long it is followed. Our choice."""

    width: float = quantity("mm", 0.1, above=0.0)
    time: float = quantity("ms", 1.0, above=0.0)


@record
class Numerics:
    """Steps and rings. Defaults by convergence (validation/gel_droplet_reduced/README.md)."""

    layers: int = whole(4, least=1)  # of the shell
    rings: int = whole(60, least=2)  # of gel, for heat; the shell has more of them, about as thick
    growth_step: float = quantity("", 5e-4, above=0.0, most=0.1)  # of D/D_0
    longest_step: float = quantity("ms", 1.0, above=0.0)
    end_time: float = quantity("s", 5.0, above=0.0)  # whether it has torn or not


class Droplet(NamedTuple):
    """A whole set of keys."""

    droplet: Drop
    shell: gel.Shell
    gel: Gel
    vapour: gel.Fuel
    heating: Heating
    vent: Vent
    numerics: Numerics


CLASSES = dict(zip(Droplet._fields, (Drop, gel.Shell, Gel, gel.Fuel, Heating, Vent, Numerics)))


def load(file: Path | None, overrides: tuple[str, ...]) -> Droplet:
    """The droplet of a TOML file (none: the base case), with `section.key=value` overrides."""
    table = cases.parsed(file) if file else {}
    for text in overrides:
        cases.put(table, text)
    return of_table(table)


def of_table(table: dict) -> Droplet:
    """The same of a parsed table."""
    for key in table:
        if key not in CLASSES:
            raise CaseError(unknown(key, CLASSES))
    own = Droplet(*(plausible(read(cls, table.get(name, {}), name), name) for name, cls in CLASSES.items()))
    _refuse_shape(own.droplet)
    gel.refuse_above_critical(own.vapour, own.droplet.ambient_pressure, "droplet.ambient_pressure_Pa")
    return own


def judged(own: Droplet, say: Callable[[str], None]) -> Droplet:
    """The same droplet; numbers far from usual and fuels of two are said."""
    far = usual.far({name: write(getattr(own, name)) for name in CLASSES}, OF_DROPLET)
    for line in (*far, *gel.mixed(own.vapour, "vapour")):
        say(f"warning: {line}")
    return own


def _refuse_shape(drop) -> None:
    """CaseError where a droplet has no such dimensions, or its bubble has no room."""
    if drop.dimensions > 3:
        raise CaseError(f"droplet.dimensions = {drop.dimensions}; it must be 2 (a cylinder) or 3 (a sphere)")
    if not drop.bubble_diameter < drop.diameter - 2.0 * drop.shell_thickness:
        raise CaseError(
            f"droplet.bubble_diameter_mm = {1e3 * drop.bubble_diameter:g}; inside the shell there are "
            f"{1e3 * drop.diameter - 2e3 * drop.shell_thickness:g} mm: give a smaller bubble or a thinner shell"
        )
