"""Checks of a case that several keys decide together; each raises a CaseError: what was given, and what is allowed."""

from __future__ import annotations

from collections import Counter

from sdph import effects, scenes
from sdph.case import (
    beside,
    bodies,
    forces,
    inlet_profiles,
    inlets,
    materials,
    meshes,
    periods,
    probed,
    regions,
    slices,
    turbulent,
)
from sdph.case.extents import inside, mouth, probe, side
from sdph.case.sections import Case, Part, Region
from sdph.effects.liquids import bubble
from sdph.laws.constants import ROUND_OFF
from sdph.methods.liquids.sections import Pool
from sdph.methods.mps.scales import KNOWN
from sdph.methods.mps.start import refuse
from sdph.methods.solids.sections import Body
from sdph.schema import CaseError, fields, unknown

MOST_OUTPUTS = 1e5  # of fields, and of history rows of a liquid as it sets them; our choice
STRETCH = 100.0  # of the last cell of a row over its first, at most, either way; our choice
NEEDS = {"box": ("lower", "upper"), "ring": ("centre", "radius", "inner_radius")}  # of a place, by its shape
OF_BOX, OF_PLANE = ("rotation", "taylor_green"), ("taylor_green", "quadrupole")  # flows of a pool at the start


def columns_of_history(case) -> None:
    """CaseError where two columns of history.csv have one name."""
    columns = [f"{name}_{key}" for name, own in case.probes.items() for key in probed.columns(case, own)]
    columns += [f"particle_{ident}_temperature_K" for ident in case.track]
    twice = [name for name, count in Counter(columns).items() if count > 1]
    if twice:
        raise CaseError(
            f"probes or track.particles give history.csv two columns {twice[0]}; "
            "rename a probe, or name a particle once"
        )


def flow(case, where: str, pool) -> None:
    """A pool has the shape and the case the dimensions that a flow at the start is known for, and a flow its speed."""
    if pool.flow in OF_BOX and pool.shape != "box":
        raise CaseError(f"{where}.flow = {pool.flow!r} is that of a box; shape = {pool.shape!r}")
    if pool.flow in OF_PLANE and case.dimensions != 2:
        raise CaseError(f"{where}.flow = {pool.flow!r} is known in two dimensions; dimensions = {case.dimensions}")
    if pool.speed and pool.flow == "uniform":
        raise CaseError(f"{where}.speed_m_s = {pool.speed:g} is that of a flow; set flow, or give velocity_m_s")


def check(case: Case) -> None:
    """Check what several keys decide together: `CaseError` where they do not fit."""
    beside.check(case)
    if case.grains:
        materials.check(case)
    if case.liquid and (case.gas is None) != (case.grains is None):
        raise CaseError("a liquid stands alone, or beside grains in a gas: give both [grains] and [gas], or neither")
    forces.check(case)
    for name in case.effects:
        if not set(effects.REGISTRY[name].matter) & set(case.matters):
            what = {"liquid": "a liquid", "solid": "a solid"}.get(case.matters[0], "grains")
            raise CaseError(f"effects holds {name}, which does not act on {what}; leave it out")
    for matter in case.matters:
        _check_one(case.only(matter))
    if case.liquid and case.solid:  # probes are of neither of the two alone
        _check_components(case)
        _check_probes(case)
    if "bubble" in case.effects:
        bubble.check_shell(case)


def _check_one(case: Case) -> None:
    """Check a case of grains alone or of a liquid alone."""
    if case.particles and case.grains is None:
        raise CaseError(f"particles.{next(iter(case.particles))} is given without [grains]; add that, or leave it out")
    if case.scene and case.scene not in scenes.names():
        raise CaseError(f"{unknown(case.scene, scenes.names()).replace('unknown key', 'scene =', 1)}; or leave it out")
    _check_phases(case)
    _check_method(case)
    if case.bodies and case.solid is None:
        raise CaseError(f"bodies.{next(iter(case.bodies))} is given without [solid]; add that, or leave it out")
    if case.resolution.cell is None and case.grains:
        raise CaseError("resolution.cell_mm is missing; it has no default: give it in [resolution]")
    _check_components(case)
    if any(not 1.0 / STRETCH <= ratio <= STRETCH for ratio in case.resolution.stretch or ()):
        given = f"resolution.stretch = {list(case.resolution.stretch)}"
        raise CaseError(f"{given}; every ratio must be from {1.0 / STRETCH:g} to {STRETCH:g}: 1 for equal cells")
    if min(case.domain.size) <= 0.0:
        raise CaseError(f"domain.size_m = {list(case.domain.size)}; every length must be above 0")
    if any(case.domain.corner) and (case.solid or case.incompressible):
        given = f"domain.lower_m = {list(case.domain.lower)}"
        known = 'grains and of a liquid that sound travels in, not of solids nor of method.name = "mps"'
        raise CaseError(f"{given} is of {known}; leave it out")
    meshes.check(case)
    periods.of_domain(case)
    turbulent.check(case)
    if any(isinstance(t, tuple) or t <= 0.0 for t in case.run.report_at):
        raise CaseError(f"run.report_at_s = {list(case.run.report_at)}; it must be a list of times above 0")
    _check_outputs(case)
    _check_pools(case)
    if case.solid:
        bodies.check(case)
    for name, boundary in case.boundaries.items():
        side(case, f"boundaries.{name}", boundary)
    inlet_profiles.check(case)
    inlets.check(case)
    for name, region in case.particles.items():
        _check_region(case, name, region)
    forces.check_parts(case)
    _check_probes(case)
    for name, profile in case.profiles.items():
        slices.check(case, f"profiles.{name}", profile)
    for name, nozzle in case.nozzles.items():
        mouth(case, f"nozzles.{name}", nozzle)


def _check_probes(case: Case) -> None:
    """Probes lie where they may, and have columns of their own."""
    for name, point in case.probes.items():
        probe(case, f"probes.{name}", point)
    columns_of_history(case)


def _check_pools(case: Case) -> None:
    """Pools have what their shapes and flows need; a second phase has one."""
    for name, pool in case.pools.items():
        if pool.shape != "tank":
            _check_place(case, f"pools.{name}", pool)
            periods.of_pool(case, f"pools.{name}", pool)
        flow(case, f"pools.{name}", pool)
    if case.gas_phase and not any(pool.phase == "gas" for pool in case.pools.values()):
        raise CaseError('[gas_phase] is given, but no pool has phase = "gas"; give one, or leave [gas_phase] out')


def _check_method(case: Case) -> None:
    """A liquid has what its method needs, and no effect that this method does not know."""
    if case.liquid is None:
        if case.method is not None and case.solid is None and case.grains is None:
            raise CaseError("[method] is of a liquid; give [liquid] too, or leave it out")
        return
    if not case.incompressible:
        if case.liquid.sound_speed is None:
            raise CaseError(
                "liquid.sound_speed_m_s is missing; a weakly compressible liquid needs it, ten times its speed"
            )
        if case.method and (idle := [key for key in bodies.given(case.method) if key != "left_out"]):
            raise CaseError(f'method.{idle[0]} is of moving particles; set method.name = "mps", or leave it out')
        for name in ("free_energy_tension", "perforation", "suction"):
            if name in case.effects:
                raise CaseError(f'effects holds {name}, which is of moving particles; set method.name = "mps"')
        return
    for name in case.effects:
        if name not in KNOWN:
            raise CaseError(
                f'effects holds {name}; with method.name = "mps" there are {", ".join(KNOWN)}: leave it out'
            )
    tension = case.parameters.get("free_energy_tension")
    held = tension is not None and tension.coefficient > 0.0 and "tank" not in case.effects
    if case.method.pressure == "weakly_compressible" and (not held or case.method.of_pools(case)):
        raise CaseError(
            'method.pressure = "weakly_compressible" is of sheets and drops that free_energy_tension holds, whose '
            'cohesion gives it its speed of sound; leave it out, or set method.name = "weakly_compressible"'
        )
    if case.gas_phase:
        raise CaseError('method.name = "mps" moves one liquid: leave [gas_phase] and pools of gas out')
    if any(case.liquid.periodic or ()) and (case.nozzles or "outflow" in case.effects):
        raise CaseError('method.name = "mps" has no periodic axes beside nozzles or outflow: leave liquid.periodic out')
    refuse(case)


def _check_components(case: Case) -> None:
    """Vectors have as many components as the case has dimensions."""
    vectors = {
        "domain.size_m": case.domain.size,
        "domain.gravity_m_s2": case.domain.gravity,
        "domain.lower_m": case.domain.lower,
        "resolution.stretch": case.resolution.stretch,
    }
    groups = ("particles", case.particles, Region), ("pools", case.pools, Pool), ("bodies", case.bodies, Body)
    groups += (("parts", case.parts, Part),)
    for group, places, cls in groups:
        for name, place in places.items():
            vectors |= {
                f"{group}.{name}.{key}": getattr(place, at)
                for key, (at, kind) in fields(cls).items()
                if kind.components is None and at != "corners"  # which are vectors themselves
            }
    for name, point in case.probes.items():
        vectors[f"probes.{name}.at_m"] = point.at
    for name, boundary in case.boundaries.items():
        vectors[f"boundaries.{name}.velocity_m_s"] = boundary.velocity
    for name, nozzle in case.nozzles.items():
        own = {"centre_m": nozzle.centre, "direction": nozzle.direction, "across": nozzle.across}
        vectors |= {f"nozzles.{name}.{key}": value for key, value in own.items()}
    if own := case.parameters.get("tank"):
        vectors |= {"tank.lower_m": own.lower, "tank.upper_m": own.upper, "tank.centre_m": own.centre}
    if own := case.parameters.get("electric_field"):
        vectors["electric_field.strength_V_m"] = own.strength
    for key, value in vectors.items():
        if value is not None and (len(value) != case.dimensions or any(isinstance(v, tuple) for v in value)):
            raise CaseError(
                f"{key} has {len(value)} components; dimensions = {case.dimensions} asks for {case.dimensions}"
            )


def _check_outputs(case: Case) -> None:
    if case.run.average_from >= case.run.end_time:
        given = f"run.average_from_s = {case.run.average_from:g}"
        raise CaseError(
            f"{given} is not before the end at {case.run.end_time:g} s; give an earlier time, or --until more"
        )
    intervals = {"run.output_interval_s": case.run.output_interval}
    if case.liquid:
        intervals["liquid.history_interval_s"] = case.liquid.history_interval
    if case.solid:
        intervals["solid.history_interval_s"] = case.solid.history_interval
    for key, interval in intervals.items():
        if interval and case.run.end_time > MOST_OUTPUTS * interval:
            given = f"{key} = {interval:g} up to run.end_time_s = {case.run.end_time:g}"
            raise CaseError(
                f"{given} makes {case.run.end_time / interval:.3g} outputs; {MOST_OUTPUTS:.0e} are allowed: lengthen "
                "the one or shorten the other"
            )


def _narrowest(where: str, part) -> float:
    """Smallest width [m] of a region or a pool; CaseError where it has none."""
    size = part.radius if part.shape != "box" else min(b - a for a, b in zip(part.lower, part.upper))
    if part.shape == "ring" and part.inner_radius >= part.radius:
        raise CaseError(f"{where}.inner_radius_m = {part.inner_radius:g} must be below radius_m = {part.radius:g}")
    size -= part.inner_radius if part.shape == "ring" else 0.0
    if size <= 0.0:
        raise CaseError(
            f"{where}: upper_m = {list(part.upper)} must lie above lower_m = {list(part.lower)} along every axis"
        )
    return size


def _check_place(case: Case, where: str, part) -> None:
    """A region or a pool has what its shape needs, is no box upside down, and no narrower than the spacing."""
    needs = NEEDS.get(part.shape, ("centre", "radius"))
    for key in needs:
        if getattr(part, key) is None:
            raise CaseError(f"{where}.{key}_m is missing; a {part.shape} needs {' and '.join(f'{n}_m' for n in needs)}")
    if getattr(part, "fill", None) is not None:
        raise CaseError(f'{where}.fill = {part.fill:g} is that of the tank; set shape = "tank", or leave it out')
    if part.shape == "ring" and case.dimensions != 2:
        given = f"{where}.shape = 'ring' is of two dimensions; dimensions = {case.dimensions}"
        raise CaseError(f"{given}: give another shape")
    size = _narrowest(where, part)
    if case.resolution.spacing > size * (1.0 + ROUND_OFF):
        spacing = f"resolution.spacing_mm = {case.resolution.spacing * 1e3:g}"
        raise CaseError(f"{spacing} is larger than {where} ({size * 1e3:g} mm); give a spacing well below that")


def _check_one_phase(case: Case) -> None:
    two = [f'pools.{name}.phase = "gas"' for name, pool in case.pools.items() if pool.phase == "gas"]
    two += [name for name in case.effects if effects.REGISTRY[name].two_phases]
    if two:
        raise CaseError(f"{two[0]} needs a second phase; give its properties in [gas_phase]")


def _check_phases(case: Case) -> None:
    if case.gas_phase is None:
        return _check_one_phase(case)
    if case.liquid is None:
        raise CaseError("[gas_phase] is given without [liquid]; a gas around grains goes into [gas]")
    if "drain" in case.effects:
        raise CaseError("effects holds drain, which knows one phase; leave it or [gas_phase] out")
    summed = case.gas_phase.density_by == "summation"
    if summed and case.liquid.pressure_gradient == "corrected":
        raise CaseError(
            'liquid.pressure_gradient = "corrected" makes energy, which gas_phase.density_by = "summation" does not '
            'take up; set "plain", or "continuity"'
        )
    if summed and "density_diffusion" in case.effects:
        raise CaseError(
            'effects holds density_diffusion, but with gas_phase.density_by = "summation" no density is advanced; '
            "leave one out"
        )


def _check_region(case: Case, name: str, region: Region) -> None:
    regions.check(case, f"particles.{name}", region)
    if region.shape in ("box", "disc", "sphere"):
        _check_place(case, f"particles.{name}", region)
    if found := regions.extents(case, region):
        inside(case, f"particles.{name}", *found)
