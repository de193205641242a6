"""States of a liquid that a run may go on from."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.engine.kept import Unfit
from sdph.engine.state import LIQUID
from sdph.running.hastened import of


def admit(scene, sets, folder, heavier):
    """Take up the start of a scene with a particle of liquid of so many times its mass."""
    run = of(cases.load(scenes.HERE / scene / "case.toml", sets), folder / "ledger.csv")
    own = run.stepper
    kept = {name: array.copy() for name, array in own.state._asdict().items() if len(array)}
    kept["mass"][kept["kind"] == LIQUID] *= heavier
    own.guard.admit_liquid(kept, own.born, range(6), int(kept["ident"].max()))


def test_what_vapour_condensed_on_is_heavier_than_all_were_at_the_start(tmp_path):
    """A droplet that was stopped after its tear could not go on."""
    gel = "gel_droplet", ("resolution.spacing_mm=0.025",), tmp_path
    admit(*gel, 1.5)
    with pytest.raises(Unfit, match="mass of particle"):
        admit(*gel, 1e6)


def test_without_vapour_no_particle_becomes_heavier(tmp_path):
    with pytest.raises(Unfit, match="mass of particle"):
        admit("taylor_green", ("resolution.spacing_mm=100",), tmp_path, 1.5)
