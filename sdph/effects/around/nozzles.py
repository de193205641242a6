"""A nozzle as a case gives it, and what must hold of it. It gives grains where the case has grains, else liquid."""

from __future__ import annotations

import numpy as np

from sdph.effects.around import rates, sizes
from sdph.effects.around.streams import Streams, layers_of, streams_of
from sdph.laws.constants import ROUND_OFF
from sdph.schema import CaseError, choice, defaults, fields, file, quantity, record, vector, whole, words

ONLY = {  # key -> shapes that have it, beside what _check_annulus, _check_table and half_angle refuse
    "width": ("slot",), "length": ("slot",), "radius": ("disc", "cone", "annulus", "table"),
    "profile": ("slot", "disc", "cone"), "seed": ("annulus", "table"), "record_set": ("table",),
    "table_from": ("table",), "diameter": ("slot", "disc", "cone"), "diameter_std": ("slot", "disc", "cone"),
}  # fmt: skip
OF_GRAINS = ("temperature", "volume_fraction", "rate", "material", *sizes.OF_LAW)


@record
class Nozzle:
    """A mouth that grains or liquid leave at `speed`: a slot, a disc, a cone, whose streams spread up to `half_angle`,
    or of liquid an annulus, whose streams turn about its axis; or drops of a `table`, with speed and radius for the
    scales of the case and the interval and scatter of what becomes one particle (sdph.effects.around.drops)."""

    shape: str = choice("slot", "disc", "cone", "annulus", "table")
    centre: tuple = vector("m")
    direction: tuple = vector("")
    speed: float = quantity("m_s", above=0.0)  # mean over the mouth
    temperature: float | None = quantity("K", None, above=0.0)  # of grains, which need it
    volume_fraction: float | None = quantity("", None, above=0.0, most=1.0)  # either this
    rate: float | None = quantity("kg_s", None, above=0.0)  # or this, per metre of depth in two dimensions
    rates: tuple = vector("", ())  # or rows [time s, rate kg/s], linear between them (sdph.effects.around.rates)
    profile: str = choice("uniform", "parabolic")  # of the speed; parabolic: none at the rim
    width: float | None = quantity("m", None, above=0.0)  # of a slot
    length: float | None = quantity("m", None, above=0.0)  # of a slot in three dimensions
    across: tuple | None = vector("", None)  # direction of its width
    radius: float | None = quantity("m", None, above=0.0)  # of a disc or cone; in two dimensions half the mouth's width
    half_angle: float = quantity("deg", 0.0, least=0.0, most=80.0)
    inner_radius: float | None = quantity("m", None, above=0.0)  # of an annulus
    swirl: float = quantity("", 0.0, least=-10.0, most=10.0)  # of an annulus: speed around the axis over that along it
    seed: int = whole(0)  # of the angles by which the layers of an annulus are turned, or a table that is played again
    table: str = file()  # CSV file of drops, with z along the direction
    # in place of the table: a scene, a case.toml or a run folder of moving particles, whose drops become the table
    record: str = words("")
    record_set: tuple = words(())  # key=value of that run
    table_from: float = quantity("s", 0.0, least=0.0)  # drops before it are left out: the sheet was still filling
    diameter: float | None = quantity("mm", None, above=0.0)  # of the grains; none: those of [grains]
    diameter_std: float | None = quantity("mm", None, least=0.0)
    # of grains: log_normal has the two above; others their own keys (sdph.effects.around.sizes)
    sizes: str = choice(*sizes.LAWS)
    size_classes: int = whole(1, least=1)  # of equal mass, that a distribution is cut into: each is a particle
    size_parameter: float | None = quantity("mm", None, above=0.0)  # X of rosin_rammler: 36.8 % of the mass is above
    size_exponent: float | None = quantity("", None, least=0.5, most=20.0)  # q of rosin_rammler
    least_diameter: float | None = quantity("mm", None, above=0.0)  # smallest drop of rosin_rammler
    most_diameter: float | None = quantity("mm", None, above=0.0)  # largest; none: no bound
    diameters: tuple = vector("mm", ())  # of sizes = "given", one by one
    shares: tuple = vector("", ())  # of the mass, of each of them; none: equal
    material: str = words("")  # of its grains, where there are several
    start: float = quantity("s", 0.0, least=0.0)
    end: float | None = quantity("s", None, above=0.0)


DEFAULTS = defaults(Nozzle)


def check(case, name: str, nozzle: Nozzle) -> None:
    where = f"nozzles.{name}"
    (_check_grains if case.grains else _check_liquid)(case, where, nozzle)
    sizes.check(case, where, nozzle)
    rates.check(case, where, nozzle)
    for key, unit_of in (("centre", "_m"), ("direction", "")):
        if len(getattr(nozzle, key)) != case.dimensions:
            raise CaseError(
                f"{where}.{key}{unit_of} has {len(getattr(nozzle, key))} components; dimensions = {case.dimensions} "
                f"asks for {case.dimensions}"
            )
    if nozzle.shape == "disc" and case.dimensions == 2:
        raise CaseError(f"{where}.shape = 'disc' is for three dimensions; in two a mouth is a slot or a cone")
    needs = ("width", "length")[: case.dimensions - 1] if nozzle.shape == "slot" else ("radius",)
    for key in needs:
        if getattr(nozzle, key) is None:
            raise CaseError(f"{where}.{key}_m is missing; a {nozzle.shape} in {case.dimensions} dimensions needs it")
    _check_annulus(case, where, nozzle)
    _check_table(case, where, nozzle)
    _refuse_idle(where, nozzle)
    if nozzle.half_angle and nozzle.shape != "cone":
        raise CaseError(f"{where}.half_angle_deg is of a cone; shape = {nozzle.shape!r}")
    if not np.linalg.norm(nozzle.direction) > 0.0:
        raise CaseError(f"{where}.direction = {list(nozzle.direction)}; it must point somewhere")
    if nozzle.across and case.dimensions == 3 and _parallel(nozzle.across, nozzle.direction):
        aside = f"it must point aside of direction = {list(nozzle.direction)}"
        raise CaseError(f"{where}.across = {list(nozzle.across)}; {aside}")
    streams = streams_of(case, nozzle)
    _check_times(case, where, nozzle, streams)
    alpha_p = streams.alpha_p
    if case.grains and alpha_p > case.grains.packing_limit:
        raise CaseError(
            f"{where} makes a volume fraction of {alpha_p:.3g}, above grains.packing_limit = "
            f"{case.grains.packing_limit}; slow down or widen it"
        )


def _check_annulus(case, where: str, nozzle: Nozzle) -> None:
    """CaseError where an annulus has no room or no liquid, or another shape has what only an annulus has."""
    if nozzle.shape != "annulus":
        if nozzle.swirl or nozzle.inner_radius is not None:
            raise CaseError(f"{where}: swirl and inner_radius_m are of an annulus; shape = {nozzle.shape!r}")
        return
    if case.grains or case.dimensions == 2 or nozzle.profile != "uniform":
        raise CaseError(f"{where}.shape = 'annulus' gives liquid in three dimensions, at one speed; take another shape")
    if nozzle.inner_radius is None or nozzle.inner_radius >= nozzle.radius:
        raise CaseError(f"{where}: an annulus needs inner_radius_m, below radius_m = {nozzle.radius:g}")


def _check_table(case, where: str, nozzle: Nozzle) -> None:
    """CaseError where a table of drops has nobody to give them to or none to give, or another shape names one."""
    if nozzle.shape != "table":
        if nozzle.table or nozzle.record:
            raise CaseError(f"{where}: table and record are of shape = 'table'; shape = {nozzle.shape!r}")
        return
    if case.grains is None or case.dimensions == 2 or nozzle.rate is None:
        raise CaseError(f"{where}.shape = 'table' gives droplets in three dimensions at rate_kg_s: give [grains] too")
    if not nozzle.table and not nozzle.record:
        raise CaseError(f"{where}.table is missing; name a CSV file of drops, or a record to make one from")


def _refuse_idle(where: str, nozzle: Nozzle) -> None:
    """CaseError of a key that does nothing for the nozzle's shape."""
    for key, (name, _) in fields(Nozzle).items():
        shapes = ONLY.get(name, (nozzle.shape,))
        if nozzle.shape not in shapes and getattr(nozzle, name) != DEFAULTS[key]:
            raise CaseError(f"{where}.{key} is of {', '.join(shapes)}; shape = {nozzle.shape!r}: leave it out")
    if nozzle.record_set and not nozzle.record:
        raise CaseError(f"{where}.record_set is of a record, and there is none: leave it out, or name one")


def _check_grains(case, where: str, nozzle: Nozzle) -> None:
    if (nozzle.volume_fraction is not None) + (nozzle.rate is not None) + bool(nozzle.rates) != 1:
        raise CaseError(f"{where}: give either volume_fraction or rate_kg_s, or rates")
    if nozzle.temperature is None:
        raise CaseError(f"{where}.temperature_K is missing; grains come in with one")


def _check_liquid(case, where: str, nozzle: Nozzle) -> None:
    """CaseError where a nozzle of liquid has what only grains have, or a second phase is there."""
    for key in OF_GRAINS:
        if getattr(nozzle, key) not in (None, (), ""):
            raise CaseError(f"{where}.{key} is of grains; a nozzle of liquid has its speed and its mouth: leave it out")
    if case.gas_phase is not None:
        raise CaseError(f"{where}: liquid comes in where there is one phase; leave out [gas_phase] or the nozzle")


def _check_times(case, where: str, nozzle: Nozzle, streams: Streams) -> None:
    """CaseError where a nozzle closes before it opens, or before it gives a layer of particles."""
    if nozzle.end is None:
        return
    given = f"{where} is open from start_s = {nozzle.start:g} to end_s = {nozzle.end:g}"
    if nozzle.end <= nozzle.start:
        raise CaseError(f"{given}; its end must come after its start")
    if nozzle.shape != "table" and not layers_of(nozzle, streams).any():
        way = (nozzle.end - nozzle.start) * streams.speed.max()
        least = f"less than half of resolution.spacing_mm = {case.resolution.spacing * 1e3:g}"
        raise CaseError(f"{given}: its grains go {way * 1e3:.3g} mm, {least}; open it longer or take a finer spacing")


def _parallel(a, b) -> bool:
    """True where two vectors of space span no plane."""
    return bool(np.linalg.norm(np.cross(a, b)) <= ROUND_OFF * np.linalg.norm(a) * np.linalg.norm(b))
