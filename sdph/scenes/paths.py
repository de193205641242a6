"""Paths of the data that travels with sdph: in the wheel, or beside the package in a checkout."""

from pathlib import Path

PACKAGE = Path(__file__).parents[1]


def data(name: str) -> Path:
    """A folder such as `openfoam_case_templates` or `validation`."""
    inside = PACKAGE / "data" / name
    return inside if inside.is_dir() else PACKAGE.parent / name


def gas_template(scene: str) -> Path:
    """OpenFOAM case of a scene's gas; a scene without its own takes the disc's: nothing in it is particular."""
    templates = data("openfoam_case_templates")
    own = templates / scene / "gas"
    return own if scene and own.is_dir() else templates / "disc_cluster" / "gas"
