"""Choice of the gas solver: OpenFOAM's, the embedded one, or with `auto` OpenFOAM's where it is and can be used.

Each solver is imported where it is made: it takes 0.15 s, and a run needs one of them.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from coupling.gas import GasError
from coupling.openfoam.programs.build import silent
from sdph import scenes
from sdph.case import read as cases
from sdph.engine.reading import one_line
from sdph.scenes import paths
from sdph.schema import CaseError

OWN_MESH = ("constant/polyMesh", "system/blockMeshDict")


def open_gas(case, folder: Path, template: Path | None, status, allow_code: bool = False):
    """The gas solver that a case asks for, its OpenFOAM case in `folder`/gas, made from `template`.

    `template` None goes on with what is in `folder`. `status` hears what is done.
    """
    _refuse_periodic(case)
    chosen = case.coupling.gas
    if chosen == "auto" and template is not None:
        return _automatic(case, folder, template, status, allow_code)
    if chosen == "openfoam" or (chosen == "auto" and (folder / "gas" / "case.foam").exists()):
        return _openfoam(case, folder, template, status, allow_code)
    return _embedded(case)


def expected(case) -> str:
    """ "openfoam" or "embedded": which solver a case gets if what is there can be used, which is not tried."""
    _refuse_periodic(case)
    from coupling.openfoam.programs import install

    given = case.coupling.gas
    chosen = given if given != "auto" else "openfoam" if install.find() else "embedded"
    if chosen == "embedded":
        _refuse_turbulence(case)
    return chosen


def _refuse_periodic(case) -> None:
    if case.domain.periodic:
        given = f"domain.periodic = {list(case.domain.periodic)}"
        raise CaseError(f"{given}, but no gas solver has periodic sides; leave it out")


def _openfoam(case, folder: Path, template: Path | None, status, allow_code: bool):
    from coupling.openfoam.solver import OpenFoamGas

    return OpenFoamGas(case, folder / "gas", template, status=status, allow_code=allow_code)


def refuse_elsewhere(case) -> None:
    """CaseError where the domain does not begin where the embedded gas does."""
    if any(case.domain.corner):
        given = f"domain.lower_m = {list(case.domain.lower)}, but the embedded gas begins at the origin"
        raise CaseError(f"{given}; leave it out, and count all places from there")


def _refuse_turbulence(case) -> None:
    if case.gas.turbulent:
        given = f'gas.turbulence.model = "{case.gas.turbulence.model}", but the embedded gas is laminar'
        raise CaseError(f"{given}; give --gas openfoam (sdph openfoam setup --install gets it), or leave it out")


def _embedded(case):
    _refuse_turbulence(case)
    refuse_elsewhere(case)
    from coupling.embedded import EmbeddedGas

    return EmbeddedGas(case)


def _automatic(case, folder: Path, template: Path, status, allow_code: bool):
    """OpenFOAM's solver; the embedded one where OpenFOAM is not there, or does not even run a case of ours."""
    why = _not_ready(status)
    if why is None:
        try:
            return _openfoam(case, folder, template, status, allow_code)
        except GasError:
            why = _trial()
            if why is None:  # OpenFOAM works: the fault is the case's
                raise
    own = next((name for name in OWN_MESH if (template / name).exists()), None)
    if own:
        raise GasError(f"{why}; {template / own} is a mesh that only OpenFOAM reads (sdph doctor says what is missing)")
    (folder / "gas" / "case.foam").unlink(missing_ok=True)  # there is nothing to open
    status(f"{why}: the gas is solved by the embedded solver (sdph openfoam setup --install mends what can be mended)")
    return _embedded(case)


def _not_ready(status) -> str | None:
    """Reason, in one line, that there is no sdphGasFoam to run; None where there is one."""
    from coupling.openfoam.programs import install

    if install.find() is None:
        return "OpenFOAM was not found"
    try:
        install.gas_solver(status)
    except (GasError, CaseError, OSError) as error:
        return f"OpenFOAM cannot be used: {one_line(error)}"
    return None


def _trial() -> str | None:
    """Reason, in one line, that OpenFOAM does not run the shipped disc; None where it does."""
    disc = cases.load(scenes.HERE / "disc_cluster" / "case.toml")
    with tempfile.TemporaryDirectory() as folder:
        try:
            _openfoam(disc, Path(folder), paths.gas_template("disc_cluster"), silent, False).close()
        except GasError as error:
            return f"OpenFOAM cannot be used: {one_line(error).partition(' (log: ')[0]}"
    return None
