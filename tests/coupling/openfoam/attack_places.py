"""Folders that hostile cases are made in, and the library that leaves a mark where it is loaded."""

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

# Written when a library is loaded, whatever it is called: found by the address of its own code
SOURCE = """
#include <dlfcn.h>
#include <stdio.h>
#include <string>
__attribute__((constructor)) static void loaded()
{
    static int here;
    Dl_info found;
    if (!dladdr(&here, &found)) return;
    if (FILE* file = fopen((std::string(found.dli_fname) + ".ran").c_str(), "w")) fclose(file);
}
"""
HEAD = "FoamFile {{ version 2.0; format ascii; class {}; object {}; }}\n"
MESH = (
    HEAD.format("dictionary", "blockMeshDict")
    + """scale 1;
vertices ((0 0 0) (0.5 0 0) (0.5 0.5 0) (0 0.5 0) (0 0 1) (0.5 0 1) (0.5 0.5 1) (0 0.5 1));
blocks (hex (0 1 2 3 4 5 6 7) (10 10 1) simpleGrading (1 1 1));
boundary
(
    @WALLS { type wall; faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2)); }
    frontAndBack { type empty; faces ((0 3 2 1) (4 5 6 7)); }
);
"""
)
CUT = (
    HEAD.format("dictionary", "decomposeParDict")
    + "numberOfSubdomains 2; method simple; simpleCoeffs { n (2 1 1); delta 0.001; }\n"
)


@dataclass(frozen=True)
class Place:
    """A folder to work in: `my_case` as it came, `outside` what else its author put on the machine, later `run`."""

    root: Path

    @property
    def case(self) -> Path:
        return self.root / "my_case"

    @property
    def gas(self) -> Path:
        return self.case / "gas"

    @property
    def library(self) -> Path:
        return self.root / "outside" / "mark.so"

    @property
    def loader(self) -> Path:
        """A dictionary outside the case, that has the library loaded."""
        return self.root / "outside" / "list"

    @property
    def ran(self) -> list[Path]:
        """What code that ran has left."""
        return list(self.root.rglob("*.ran"))

    def filled(self, text: str) -> str:
        """A text with the places in it."""
        places = {"@LIB": self.library, "@LIST": self.loader, "@DIR": self.loader.parent}
        for name, path in places.items():
            text = text.replace(name, str(path))
        return text

    def add(self, name: str, text: str | bytes, to: Path | None = None) -> None:
        """Append to a file of the OpenFOAM case, or make it."""
        path = (to or self.gas) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("ab") as file:
            file.write(text if isinstance(text, bytes) else self.filled(text).encode())

    def change(self, name: str, old: str, new: str, to: Path | None = None) -> None:
        path = (to or self.gas) / name
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, self.filled(new), 1))


def build_library(target: Path) -> None:
    """The library that leaves a mark, compiled."""
    command = ["g++", "-shared", "-fPIC", "-x", "c++", "-", "-o", str(target), "-ldl"]
    subprocess.run(command, input=SOURCE, text=True, check=True)


def make_place(root: Path, case: Path, library: Path) -> Place:
    """A place with a fresh case, in a folder that is empty."""
    place = Place(root)
    shutil.copytree(case, place.case)
    place.library.parent.mkdir()
    shutil.copy(library, place.library)
    place.add("list", 'libs ("@LIB");\n', place.loader.parent)
    return place
