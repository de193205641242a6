"""Files that a case names: looked at before a run begins, and kept in its folder, so that it needs nothing else.

    RUN/inputs/walls.mesh/plate.stl   a file, under its key
    RUN/inputs/nozzles.jet.table/drops.csv
    RUN/inputs/gas/                   the OpenFOAM case that the gas began with

In a case file a path is taken from the folder of that file, after --set from the working directory (`case.load`). A
`Case` holds absolute paths; RUN/case.toml and the checkpoints name the copies by their way from RUN.
"""

from __future__ import annotations

import contextlib
import dataclasses
import hashlib
import io
import os
import shutil
import tomllib
import warnings
from pathlib import Path
from urllib.parse import quote

import numpy as np
import tomli_w

from coupling.openfoam.code import refuse_code
from sdph import scenes
from sdph.case import read as cases
from sdph.effects.around import drops, frame, tank
from sdph.engine import regions, surface
from sdph.engine.reading import one_line
from sdph.engine.walls import facets
from sdph.running import output
from sdph.schema import CaseError

FOLDER, DROPS = "inputs", "droplets.csv"
GROUPED = (("nozzles", "table"), ("particles", "mesh"))  # sections with names, and their key that names a file
FROM = "in a case file a path is taken from the folder of that file, after --set from the working directory"
READERS = {  # key -> what the run makes of its file
    "walls.mesh": lambda case: _facets(case),
    "tank.mesh": lambda case: tank.shape_of(case).surface(),
    "frame.table": lambda case: frame.motion(case.parameters["frame"], case.run.end_time),
}


def named(case) -> dict[str, str]:
    """Key -> path of the files that a case names."""
    found = {}
    for section, key in cases.FILES:
        path = getattr(case.parameters.get(section), key, "")
        found |= {f"{section}.{key}": path} if path else {}
    return found | {
        f"{group}.{safe(name)}.{key}": getattr(own, key)
        for group, key in GROUPED
        for name, own in getattr(case, group).items()
        if getattr(own, key)
    }


def safe(name: str) -> str:
    """The name of a section as a file can be called, each by another."""
    return quote(name, safe=" ")


def check(case) -> None:
    """CaseError where a file that a case names is missing or cannot be read, or a nozzle records what has no drops."""
    for key, path in named(case).items():
        if not os.path.isfile(path):
            raise CaseError(f"{key} = {path!r}: there is no such file; {FROM}")
        try:
            with _silence():
                _reader(key)(case)
        except CaseError:
            raise
        except Exception as error:  # whatever the parsers of meshio stumble on
            raise CaseError(f"{key} = {path!r} cannot be read ({one_line(error)}); give a file that is whole") from None
    for name, nozzle in case.nozzles.items():
        if nozzle.record and not nozzle.table:
            recorded(f"nozzles.{name}", nozzle)


def recorded(where: str, nozzle):
    """The case that a nozzle records, and the folder of its run where it has been run already, else None."""
    given = f"{where}.record = {nozzle.record!r}"
    _, file = scenes.find(nozzle.record)
    done = file.parent if (file.parent / DROPS).is_file() else None
    if done and nozzle.record_set:
        raise CaseError(f"{given} has been run already; leave {where}.record_set out, or name its case")
    case = cases.load(file, nozzle.record_set)
    if not case.incompressible or "outflow" not in case.effects or not case.nozzles:
        raise CaseError(f'{given} tells of no drops: it must have method.name = "mps", a nozzle and outflow')
    if len(case.nozzles) > 1 or case.dimensions == 2:
        has = f"nozzles, {len(case.nozzles)}, in {case.dimensions} dimensions"
        raise CaseError(f"{given} has {has}; drops are told about the axis of one in space: name a case of such")
    return case, done


def _reader(key: str):
    """Reader of the file that a key names."""
    if key.startswith("particles."):
        return _regions
    return READERS.get(key, _read_table)


def _facets(case) -> None:
    own, size = case.parameters["walls"], case.domain.size
    corners = facets.read(own.mesh, case.dimensions, surface.unit(own)).reshape(-1, case.dimensions)
    if not len(corners):
        raise CaseError(f"walls.mesh = {own.mesh!r} has no facet that is of a size; give one that has")
    surface.refuse_size("walls.mesh", own.mesh, corners, size, case.resolution.spacing)


def _regions(case) -> None:
    for name, region in case.particles.items():
        if region.mesh:
            corners = np.array(regions.bounds(region, None, case.dimensions))
            key = f"particles.{name}.mesh"
            surface.refuse_size(key, region.mesh, corners, case.domain.size, case.resolution.spacing)


def _read_table(case) -> None:
    for nozzle in case.nozzles.values():
        if nozzle.table:
            drops.Replay(case, nozzle)


@contextlib.contextmanager
def _silence():
    """Keeps what meshio prints and warns of from the terminal: the error says it."""
    nowhere = io.StringIO()
    with warnings.catch_warnings(), contextlib.redirect_stdout(nowhere), contextlib.redirect_stderr(nowhere):
        warnings.simplefilter("ignore")
        yield


def keep(case, folder: Path):
    """The case with copies of its files in a run folder in place of what it names."""
    return _with_paths(case, {key: _copied(key, Path(path), folder) for key, path in named(case).items()})


def _copied(key: str, source: Path, folder: Path) -> str:
    target = Path(os.path.abspath(folder / place(key, source)))
    target.parent.mkdir(parents=True, exist_ok=True)
    if not (target.exists() and target.samefile(source)):
        shutil.copyfile(source, target)
    return str(target)


def place(key: str, source: Path) -> str:
    """Path of a kept file, from the run folder."""
    return f"{FOLDER}/{key}/{source.name}"


def seen_from(case, folder: Path):
    """The case with files in a run folder named by their way from there, as it is written down."""
    base = os.path.abspath(folder)
    inside = {key: path for key, path in named(case).items() if Path(path).is_relative_to(base)}
    return _with_paths(case, {key: Path(path).relative_to(base).as_posix() for key, path in inside.items()})


def _with_paths(case, paths_: dict[str, str]):
    """The case with other paths, key -> path."""
    parameters, groups = dict(case.parameters), {}
    for group, key in GROUPED:
        groups[group] = {
            name: dataclasses.replace(own, **{key: paths_.pop(f"{group}.{safe(name)}.{key}", getattr(own, key))})
            for name, own in getattr(case, group).items()
        }
    for key, path in paths_.items():
        section, name = key.split(".")
        parameters[section] = dataclasses.replace(parameters[section], **{name: path})
    return dataclasses.replace(case, parameters=parameters, **groups)


def gas_of(folder: Path) -> Path:
    """The OpenFOAM case that the gas of a run began with: one that was cut at its start begins again from there."""
    return folder / FOLDER / "gas"


def beside(file: Path) -> Path | None:
    """The OpenFOAM case that comes with a case file: the folder gas beside it, or of a run what its gas began with, not
    as it was left; None where there is none."""
    own = gas_of(file.parent) if (file.parent / output.ORIGIN).is_file() else file.parent / "gas"
    return own if own.is_dir() else None


def digests(case, file: Path) -> list[str]:
    """Digests of the files that a case reads, and of those of the OpenFOAM case beside its `file`."""
    own = beside(file)
    found = [*map(Path, named(case).values()), *(sorted(own.rglob("*")) if own else ())]
    return [hashlib.sha256(path.read_bytes()).hexdigest() for path in found if path.is_file()]


def keep_gas(template: Path, folder: Path, allow_code: bool) -> None:
    """Copy the OpenFOAM case of the gas into a run folder. What it links to would be copied too: code is looked for
    before."""
    if not allow_code:
        refuse_code(template)
    try:
        shutil.copytree(template, gas_of(folder))
    except shutil.Error as error:  # of several files, each with its reason
        source, _, reason = error.args[0][0]
        raise CaseError(f"{source} cannot be copied ({reason}); mend the OpenFOAM case {template}") from None


def prepare(case, folder: Path, template: Path, allow_code: bool):
    """The case with its files, and the OpenFOAM case `template` of its gas, in a new run folder, which a run can go on
    with from then on."""
    case = keep(case, folder)
    if "grains" in case.matters and case.coupling.gas != "embedded":
        keep_gas(template, folder, allow_code)
    output.write_origin(folder)
    output.write_text(folder / output.MARK, cases.dumps(seen_from(case, folder)))
    return case


def copy_case(file: Path, folder: Path) -> None:
    """case.toml in a new folder, with copies of the files that it names."""
    text = file.read_text(encoding="utf-8")
    table = tomllib.loads(text)
    for before, after in take_along(table, file.parent, folder):
        text = text.replace(f'"{before}"', f'"{after}"')
    if tomllib.loads(text) != table:  # a value written in another way: comments are lost
        text = tomli_w.dumps(table)
    output.write_text(folder / output.MARK, text)


def take_along(table: dict, base: Path, folder: Path) -> list[tuple[str, str]]:
    """Copy the files that a table names, from the folder `base`, into `folder`; (path before, path now) of each."""
    changed = []
    for where, entries, key in cases.files(table):
        source, before = base / entries[key], entries[key]
        if key == "record":
            entries[key] = os.path.abspath(source)
        else:
            *group, name = where.split(".", 1)
            entries[key] = place(".".join([*group, safe(name), key]), source)
            _copied(".".join([*group, safe(name), key]), source, folder)
        changed.append((before, entries[key]))
    return changed
