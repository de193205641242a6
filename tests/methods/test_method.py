"""Grains, liquids, solids and moving particles are methods: what a run needs of one, all have."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.methods.grains.grains import Grains
from sdph.methods.liquids.liquid import Liquid
from sdph.methods.method import Method, OwnLedger
from sdph.methods.mps.mps import Mps
from sdph.methods.solids.solid import Solids


def of(scene, *more):
    return cases.load(scenes.HERE / scene / "case.toml", more)


@pytest.mark.parametrize(
    "made",
    [
        lambda folder: Grains(of("disc_cluster", "resolution.spacing_mm=20", "resolution.cell_mm=50")),
        lambda folder: Liquid(of("dam_break", "resolution.spacing_mm=20"), folder / "ledger.csv", 0.0),
        lambda folder: Mps(
            of("dam_break", "resolution.spacing_mm=20", "method.name='mps'"), folder / "ledger.csv", 0.0
        ),
        lambda folder: Solids(of("oscillating_plate", "resolution.spacing_mm=5"), folder / "ledger.csv", 0.0),
    ],
)
def test_each_is_a_method(made, tmp_path):
    own = made(tmp_path)
    assert isinstance(own, Method)
    assert isinstance(own, OwnLedger) != isinstance(own, Grains)
    lacking = [name for name in own.KEPT if not hasattr(own, name)]
    assert own.matter and not lacking
