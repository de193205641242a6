"""Writing an OpenFOAM case: a template's files, the numbers of the case as macros, and the mesh.

`constant/sdphCase` holds every value of the resolved case in SI as `<section>_<attribute> value;`, so that
a template needs nothing but `#include "sdphCase"` and `$gas_density`. `system/blockMeshDict`,
`system/decomposeParDict` and the start fields `0/*` are made unless the folder brings its own.
"""

from __future__ import annotations

import dataclasses
import re
import shutil
from pathlib import Path

import numpy as np

from coupling.openfoam import dictionary, links, poly_mesh
from coupling.openfoam.block_mesh import block_mesh
from coupling.openfoam.code import Findings, refuse_code
from coupling.openfoam.start_fields import CYCLIC, EMPTY, start_fields
from coupling.openfoam.turbulence import write_properties
from sdph.case import inlet_profiles
from sdph.case.gas_cells import cells
from sdph.schema import CaseError

HEAD = "FoamFile {{ version 2.0; format ascii; class dictionary; object {name}; }}\n"
SPATIAL = ("m", "m_s", "m_s2")  # units of what has one component per dimension
NOT_SPATIAL = ("span",)  # lengths, but along the tangential axes
NAME = re.compile(r"[\w.+-]+")  # of what a case names: no more than a word of OpenFOAM
SYMMETRY = 'give it the type patch in constant/polyMesh/boundary and kind = "slip_wall"'
AROUND = "mesh the whole vessel, or a slab of it"
CONSTRAINED = {"symmetry": SYMMETRY, "symmetryPlane": SYMMETRY} | dict.fromkeys(("wedge", "cyclicAMI"), AROUND)
DEPTH = 1.0  # m, of the one cell that a two-dimensional mesh is deep
FACING = 1e-6  # of their area: what faces of cyclic patches and those opposite may differ by; digits of a mesh


def refuse_path(folder: Path, remedy: str = "move the run, give another --out, or --gas embedded") -> None:
    """CaseError where OpenFOAM cannot work in a folder; `remedy`: what to do, usually of who runs a case."""
    if not links.takes(folder.absolute()):
        raise CaseError(f"{folder.absolute()}: OpenFOAM takes no blanks and quotes in a path; {remedy}")


def refuse_names(case, remedy: str = "rename it, or give --gas embedded") -> None:
    """The same where it cannot name the boundaries of a case."""
    for name in case.boundaries:
        if not NAME.fullmatch(name):
            raise CaseError(f"boundaries.{name!r}: OpenFOAM takes letters, digits and _ . + - in a name; {remedy}")


def refuse_reference(case, folder: Path) -> None:
    """The same of a reference in `folder` that a run is compared with: it has no other gas."""
    refuse_path(folder, "the reference is a run of OpenFOAM there: move the run to a path without them")
    refuse_names(case, "the reference is a run of OpenFOAM: rename it and run the case anew")


def write_case(
    case, template: Path, folder: Path, ranks: int = 1, allow_code: bool = False,
    known: dict[Path, Findings] | None = None,
) -> None:  # fmt: skip
    """Make `folder` the OpenFOAM case of `case`: `template`'s files, macros, and the dictionary of the mesh.

    The start fields of an own blockMeshDict ask for its mesh: `write_start_fields` after that is made.
    `known` keeps what was read of the template, for who reads the copy (see `refuse_code`).
    """
    if not (template / "system" / "controlDict").exists():
        raise CaseError(
            f"{template} is no OpenFOAM case: it has no system/controlDict; the folder gas of `sdph init disc_cluster "
            "DIR` has all but your mesh"
        )
    refuse_names(case)
    if not allow_code:
        refuse_code(template, known)
    shutil.copytree(template, folder, dirs_exist_ok=True)
    write_macros(case, folder)
    write_properties(case, folder)
    mesh, blocks = ((folder / name).exists() for name in (poly_mesh.FOLDER, poly_mesh.BLOCKS))
    inlet_profiles.check(case, own_mesh=mesh or blocks)
    if mesh or not blocks:  # the patches of others are known when they are made
        write_start_fields(case, folder)
    if not mesh:
        write_block_mesh(case, folder)
    if ranks > 1:
        write_decomposition(case, folder, ranks)


def refuse_unread(template: Path) -> None:
    """CaseError where a case asks for what sdphGasFoam does not do: sources of its own, functions during the run."""
    for folder in ("constant", "system"):
        if dictionary.content(template / folder / "fvOptions") is not None:
            raise CaseError(f"{template / folder}/fvOptions: sdphGasFoam has no sources of its own; leave it out")
    if dictionary.read(template / "system" / "controlDict").get("functions"):
        raise CaseError(
            f"{template}/system/controlDict: sdphGasFoam calls no functions; leave them out, and give [probes.NAME], "
            "run.metrics or run.forces in case.toml"
        )


def write_macros(case, folder: Path) -> None:
    """`constant/sdphCase`."""
    (folder / "constant").mkdir(exist_ok=True, parents=True)
    lines = "".join(f"{name} {value};\n" for name, value in macros(case).items())
    (folder / "constant" / "sdphCase").write_text(
        f"// Written by sdph from case.toml, in SI units\n{lines}", encoding="utf-8"
    )


def macros(case) -> dict[str, str]:
    """Name -> value, as OpenFOAM reads it, of everything in the case."""
    found = {"dimensions": str(case.dimensions)}
    for field in dataclasses.fields(case):
        _flatten(field.name.removeprefix("parameters"), getattr(case, field.name), case.dimensions, found)
    if case.dimensions == 2:
        found["domain_size"] = _list([*case.domain.size, DEPTH])
    return found


def _flatten(prefix: str, value, dimensions: int, found: dict[str, str]) -> None:
    """The parameters of an effect go under its own name, those of a group under group_name."""
    if isinstance(value, dict):
        for name, entry in value.items():
            _flatten(f"{prefix}_{''.join(NAME.findall(name))}".lstrip("_"), entry, dimensions, found)
    elif dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            entry = getattr(value, field.name)
            if _is_spatial(field, entry, dimensions):
                entry = (*entry, *[0.0] * (3 - dimensions))
            _flatten(f"{prefix}_{field.name}", entry, dimensions, found)
    elif value is not None:
        found[prefix] = _entry(value)


def _is_spatial(field: dataclasses.Field, value, dimensions: int) -> bool:
    kind = field.metadata.get("kind")
    is_vector = isinstance(value, tuple) and len(value) == dimensions and not isinstance(value[0], tuple)
    return kind is not None and kind.unit in SPATIAL and is_vector and field.name not in NOT_SPATIAL


def _entry(value) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (tuple, list)):
        return _list(value)
    if isinstance(value, str):
        return value if re.fullmatch(r"[A-Za-z_]\w*", value) else '"{}"'.format(re.sub(r'["$#;{}\\]', " ", value))
    return repr(value)


def _list(values) -> str:
    return f"({' '.join(_entry(v) for v in values)})"


def write_start_fields(case, folder: Path) -> None:
    """`0/*`, those that the folder lacks."""
    (folder / "0").mkdir(exist_ok=True)
    for name, text in start_fields(case, others(case, folder)).items():
        if not (folder / "0" / name).exists():
            (folder / "0" / name).write_text(text, encoding="utf-8")


def others(case, folder: Path) -> dict[str, str] | None:
    """Name -> type of the patches of an own mesh that the case does not name, as walls; None of a mesh to be made."""
    if not (folder / poly_mesh.FOLDER).is_dir():
        return None
    known = poly_mesh.patches(folder)
    for name, patch in known.items():
        if patch.kind in CONSTRAINED:
            raise CaseError(
                f"patch {name} of the mesh of the gas is {patch.kind}, which sdphGasFoam does not know: "
                f"{CONSTRAINED[patch.kind]}"
            )
    for name in case.boundaries:
        if name not in known:
            raise CaseError(f"boundaries.{name} is no patch of the mesh of the gas; it has {', '.join(known)}")
    around = {name: patch.other for name, patch in known.items() if patch.kind == CYCLIC and _has_faces(patch)}
    if around:
        refuse_around(case, around, poly_mesh.read(folder))
    return _walls({name: patch for name, patch in known.items() if name not in case.boundaries})


def refuse_around(case, around: dict[str, str], mesh: poly_mesh.PolyMesh) -> None:
    """CaseError where gas cannot go round by the cyclic patches of a mesh, each with the one on its other side: what is
    in it or pulls at it does not, or they are not opposite each other."""
    what = f"the mesh of the gas has cyclic patches ({', '.join(around)})"
    if case.particles or case.nozzles:
        raise CaseError(f"{what}, and particles do not go round with the gas: leave them out, or {AROUND}")
    gravity = np.array([*case.domain.gravity, 0.0][:3])
    for name, other in around.items():
        if name in case.boundaries:
            raise CaseError(f"patch {name} of the mesh of the gas is cyclic: leave boundaries.{name} out")
        here, there = (
            mesh.areas[mesh.patches[side].faces] if side in around else np.zeros((0, 3)) for side in (name, other)
        )
        if len(here) != len(there) or np.abs(here + there).max() > FACING * np.abs(here).max():
            raise CaseError(
                f"{what}, {name} and {other} not opposite each other: gas goes round straight ahead alone; {AROUND}"
            )
        way = np.subtract(*(mesh.centres[mesh.patches[side].faces].mean(axis=0) for side in (other, name)))
        if abs(way @ gravity) > FACING * np.linalg.norm(way) * np.linalg.norm(gravity):
            raise CaseError(
                f"{what}, and domain.gravity_m_s2 is along them, which would have no end: set it across them"
            )


def _has_faces(patch: poly_mesh.Patch) -> bool:
    return patch.faces.stop > patch.faces.start


def _walls(others: dict) -> dict[str, str]:
    """Name -> type of patches that the case does not name; CaseError where one is no wall."""
    for name, patch in others.items():
        if patch.kind not in ("wall", EMPTY, CYCLIC) and _has_faces(patch):
            raise CaseError(
                f"patch {name} of the mesh of the gas (type {patch.kind}) stands not in [boundaries]; give "
                f"[boundaries.{name}] with its kind, as sdphGasFoam needs its fields"
            )
    return {name: patch.kind for name, patch in others.items()}


def write_block_mesh(case, folder: Path) -> None:
    """`system/blockMeshDict`, unless the folder has one."""
    path = folder / "system" / "blockMeshDict"
    if not path.exists():
        if any(case.domain.corner):
            raise CaseError(
                f"domain.lower_m = {list(case.domain.lower)} is of a mesh of your own in the folder gas; one that is "
                "made begins at the origin: leave it out"
            )
        path.write_text(HEAD.format(name="blockMeshDict") + block_mesh(case, DEPTH), encoding="utf-8")


def write_decomposition(case, folder: Path, ranks: int) -> None:
    """`system/decomposeParDict`, unless the folder has one: slabs along the longest side."""
    path = folder / "system" / "decomposeParDict"
    if path.exists():
        return
    size = case.domain.size
    longest = size.index(max(size))
    most = cells(case)[longest]
    if ranks > most:
        raise CaseError(
            f"coupling.gas_ranks = {ranks}; the gas is cut along its longest side, which has {most} cells: give that "
            "many at most"
        )
    counts = " ".join(str(ranks) if axis == longest else "1" for axis in range(3))
    text = f"numberOfSubdomains {ranks};\nmethod simple;\nsimpleCoeffs {{ n ({counts}); delta 0.001; }}\n"
    path.write_text(HEAD.format(name="decomposeParDict") + text, encoding="utf-8")
