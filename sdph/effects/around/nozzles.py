"""A nozzle as a case gives it, and what must hold of it."""

from __future__ import annotations

import numpy as np

from sdph.effects.around.streams import ROUND_OFF, Streams, layers_of, streams_of
from sdph.schema import CaseError, choice, quantity, record, vector


@record
class Nozzle:
    """A mouth that grains leave at `speed`: a slot, a disc, or a cone, whose streams spread up to `half_angle`."""

    shape: str = choice("slot", "disc", "cone")
    centre: tuple = vector("m")
    direction: tuple = vector("")
    speed: float = quantity("m_s", above=0.0)  # mean over the mouth
    temperature: float = quantity("K", above=0.0)
    volume_fraction: float | None = quantity("", None, above=0.0, most=1.0)  # either this
    rate: float | None = quantity("kg_s", None, above=0.0)  # or this, per metre of depth in two dimensions
    profile: str = choice("uniform", "parabolic")  # of the speed; parabolic: none at the rim
    width: float | None = quantity("m", None, above=0.0)  # of a slot
    length: float | None = quantity("m", None, above=0.0)  # of a slot in three dimensions
    across: tuple | None = vector("", None)  # direction of its width
    radius: float | None = quantity("m", None, above=0.0)  # of a disc or cone; in two dimensions half the mouth's width
    half_angle: float = quantity("deg", 0.0, least=0.0, most=80.0)
    diameter: float | None = quantity("mm", None, above=0.0)  # of the grains; none: those of [grains]
    diameter_std: float | None = quantity("mm", None, least=0.0)
    start: float = quantity("s", 0.0, least=0.0)
    end: float | None = quantity("s", None, above=0.0)


def check(case, name: str, nozzle: Nozzle) -> None:
    where = f"nozzles.{name}"
    if (nozzle.volume_fraction is None) == (nozzle.rate is None):
        raise CaseError(f"{where}: give either volume_fraction or rate_kg_s")
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
    if alpha_p > case.grains.packing_limit:
        raise CaseError(
            f"{where} makes a volume fraction of {alpha_p:.3g}, above grains.packing_limit = "
            f"{case.grains.packing_limit}; slow down or widen it"
        )


def _check_times(case, where: str, nozzle: Nozzle, streams: Streams) -> None:
    """CaseError where a nozzle closes before it opens, or before it gives a layer of particles."""
    if nozzle.end is None:
        return
    given = f"{where} is open from start_s = {nozzle.start:g} to end_s = {nozzle.end:g}"
    if nozzle.end <= nozzle.start:
        raise CaseError(f"{given}; its end must come after its start")
    if not layers_of(nozzle, streams).any():
        way = (nozzle.end - nozzle.start) * streams.speed.max()
        least = f"less than half of resolution.spacing_mm = {case.resolution.spacing * 1e3:g}"
        raise CaseError(f"{given}: its grains go {way * 1e3:.3g} mm, {least}; open it longer or take a finer spacing")


def _parallel(a, b) -> bool:
    """True where two vectors of space span no plane."""
    return bool(np.linalg.norm(np.cross(a, b)) <= ROUND_OFF * np.linalg.norm(a) * np.linalg.norm(b))
