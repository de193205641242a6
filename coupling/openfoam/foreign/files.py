"""Places of an OpenFOAM case: the folder it starts from, its phases, and the fields of those."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from coupling.openfoam import dictionary
from coupling.openfoam.dictionary import word
from coupling.openfoam.poly_mesh import FOLDER
from sdph.schema import CaseError

UNIFORM = re.compile(rb"internalField\s+uniform\s+([^;]+);")
TIME = re.compile(r"\d+(\.\d+)?(e[-+]?\d+)?")  # name of a folder of fields
LIST = re.compile(rb"internalField\s+nonuniform\s+List<scalar>\s*(\d+)\s*\(")


class Files:
    """An OpenFOAM case in `folder`; `phase` and `grains` are the names of its gas and of its grains, empty in a case of
    one phase."""

    def __init__(self, folder: Path):
        self.folder = Path(folder)
        _require(self.folder)
        self.control = self.read("system/controlDict")
        self.start = self._start()
        self.phases = self.read("constant/phaseProperties")
        self.phase, self.grains = self._phases()

    def read(self, name: str) -> dict:
        """Entries of a file of the case; empty where it has none."""
        return dictionary.read(self.folder / name)

    def first(self, *names: str) -> dict:
        """Entries of the first of some files that is there."""
        return next((found for name in names if (found := self.read(name))), {})

    def field(self, *names: str) -> dict:
        """A field at the start: of the gas where fields are told apart by phase."""
        own = [f"{name}.{self.phase}" for name in names] if self.phase else []
        return self.first(*(f"{self.start}/{name}" for name in (*own, *names)))

    def inside(self, *names: str) -> np.ndarray | None:
        """Values inside of the first of some fields that is there, as `field` looks for it; one where all are alike."""
        own = [f"{name}.{self.phase}" for name in names] if self.phase else []
        return next((found for name in (*own, *names) if (found := self.values(name, 1)) is not None), None)

    def of_phase(self, phase: str) -> dict:
        """Properties of a phase, or of the one there is."""
        names = ("thermophysicalProperties", "physicalProperties", "transportProperties")
        own = [f"constant/{name}.{phase}" for name in names] if phase else []
        return self.first(*own, *(f"constant/{name}" for name in names))

    def values(self, name: str, cells: int) -> np.ndarray | None:
        """(C,) of a scalar field at the start; None where there is none."""
        data = dictionary.content(self.folder / self.start / name)
        if data is None:
            return None
        if found := LIST.search(data):
            count = int(found.group(1))
            if re.search(rb"format\s+binary", data[:2000]):
                return np.frombuffer(data, np.float64, count, found.end())
            return np.array(data[found.end() : data.index(b")", found.end())].split(), float)
        same = dictionary.number(dictionary.read(self.folder / self.start / name).get("internalField"))
        return None if same is None else np.full(cells, same)

    def _start(self) -> str:
        """Name of the folder that the case starts from; 0.orig where it is still to be copied; none of a mesh alone."""
        named = f"{dictionary.number(self.control.get('startTime')) or 0.0:g}"
        for name in (named, "0", "0.orig"):
            if (self.folder / name).is_dir():
                return name
        times = sorted(path.name for path in self.folder.iterdir() if path.is_dir() and TIME.fullmatch(path.name))
        if not times:
            return named  # a mesh alone
        raise CaseError(
            f"{self.folder} has no fields to start from (no folder {named} and no 0.orig, but {', '.join(times[:3])}); "
            f"copy one of these to {named}, or make {named} empty and give conditions in case.toml"
        )

    def _phases(self) -> tuple[str, str]:
        """Names of the gas and of the grains: these have a constant diameter, and the larger density."""
        names = self.phases.get("phases", [])
        names = [n for n in (names[0] if names and isinstance(names[0], list) else names) if isinstance(n, str)]
        if len(names) != 2:
            return ("", "") if len(names) < 2 else (names[-1], names[0])
        sized = [n for n in names if word(self.phases.get(n, {}).get("diameterModel")) == "constant"] or names
        heavy = max(sized, key=lambda name: density(self.of_phase(name)) or 0.0)
        return next(n for n in names if n != heavy), heavy


def density(properties: dict) -> float | None:
    """rho [kg/m3] that properties of a phase give."""
    mixture = properties.get("mixture", properties)
    own = mixture.get("equationOfState", {}) if isinstance(mixture, dict) else {}
    found = dictionary.number(own.get("rho")) if isinstance(own, dict) else None
    return found or dictionary.number(properties.get("rho"))


def _require(folder: Path) -> None:
    if not folder.is_dir():
        raise CaseError(f"{folder}: there is no such folder; give that of an OpenFOAM case")
    if not (folder / "system" / "controlDict").is_file():
        raise CaseError(f"{folder} is no OpenFOAM case: it has no system/controlDict; give the folder that has it")
    mesh = folder / FOLDER
    if not any((mesh / name).is_file() for name in ("points", "points.gz")):
        how = "run blockMesh there" if (folder / "system/blockMeshDict").is_file() else "make it (blockMesh, ...)"
        raise CaseError(f"{folder} has no mesh yet (no {FOLDER}/points); {how} first")
