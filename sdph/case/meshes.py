"""Unit and place of the surface meshes that a case names."""

from __future__ import annotations

from sdph.schema import CaseError

KEYS = {"mesh_scale": 1.0, "mesh_offset_m": None}  # what a section gives of its mesh, and what it is else


def check(case) -> None:
    """CaseError where unit or place is given of a mesh that is not there, or a place of other dimensions."""
    regions = ((f"particles.{name}", own) for name, own in case.particles.items())
    for name, own in (*case.parameters.items(), *regions):
        if hasattr(own, "mesh_offset"):
            _check(case, name, own)


def _check(case, name: str, own) -> None:
    given = {"mesh_scale": own.mesh_scale, "mesh_offset_m": own.mesh_offset}
    for key, value in given.items():
        if value != KEYS[key] and not own.mesh:
            told = f"{value:g}" if key == "mesh_scale" else list(value)
            raise CaseError(f"{name}.{key} = {told}, and {name} names no mesh; name it, or leave it out")
    if own.mesh_offset is not None and len(own.mesh_offset) != case.dimensions:
        asked = f"dimensions = {case.dimensions} asks for {case.dimensions}"
        raise CaseError(f"{name}.mesh_offset_m has {len(own.mesh_offset)} components; {asked}")
