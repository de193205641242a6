"""Nozzles whose mouth reaches out of the gas are refused: what comes in there would be lost without a word."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
import pyvista

from sdph import scenes
from sdph.case import read as cases
from sdph.running import vessel
from sdph.schema import CaseError


def sprayed(**nozzle):
    """The scene of a jet, its nozzle in the left side of a box."""
    case = cases.load(scenes.find("evaporating_jet")[1])
    own = dataclasses.replace(case.nozzles["jet"], **nozzle)
    return dataclasses.replace(case, nozzles={"jet": own})


BOX = SimpleNamespace()  # a gas without a case of OpenFOAM: it fills the domain


def test_a_mouth_in_a_wall_is_fine():
    vessel.refuse_mouths_outside(sprayed(), BOX)


@pytest.mark.parametrize(("nozzle", "all_of_it"), [({"direction": (1.0, 0.8)}, False), ({"centre": (-0.5, 2.0)}, True)])
def test_a_mouth_that_reaches_out_is_refused(nozzle, all_of_it):
    with pytest.raises(CaseError, match=r"nozzles.jet: (\d+) of its (\d+) streams come in outside the gas") as said:
        vessel.refuse_mouths_outside(sprayed(**nozzle), BOX)
    out, streams = (int(word) for word in np.array(str(said.value).split())[[1, 4]])
    assert 0 < out < streams or (all_of_it and out == streams)


def test_what_is_periodic_has_no_outside():
    case = sprayed(centre=(1.0, -0.1))
    domain = dataclasses.replace(case.domain, periodic=("y",))
    vessel.refuse_mouths_outside(dataclasses.replace(case, domain=domain), BOX)


def test_a_mouth_beside_a_mesh_of_ones_own_is_refused(monkeypatch):
    """The mesh fills the left half of the domain alone."""
    size = sprayed().domain.size
    cells = pyvista.ImageData(
        dimensions=(3, 3, 2), spacing=(size[0] / 4.0, size[1] / 2.0, 1.0), origin=(0.0, 0.0, -0.5)
    )
    monkeypatch.setattr(vessel.output, "gas_grid", lambda gas: (cells.cast_to_unstructured_grid(), None))
    own = SimpleNamespace(case_folder="gas")
    vessel.refuse_mouths_outside(sprayed(), own)
    with pytest.raises(CaseError, match="come in outside the gas"):
        vessel.refuse_mouths_outside(sprayed(centre=(0.6 * size[0], 0.5 * size[1])), own)
