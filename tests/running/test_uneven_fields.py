"""Fields of an OpenFOAM case that are uneven, or not known: means are taken and told by `init --from-openfoam`."""

import foam_cases
import numpy as np
import pytest
from test_adopted import adopted, tetrahedra

from coupling.openfoam import poly_mesh
from coupling.openfoam.foreign import conditions


def uneven(folder, name: str, values, inside=None) -> None:
    """A field of the cube of tetrahedra: `values` on its patch, and inside `inside` or the same over and over."""
    cells = len(poly_mesh.PolyMesh(folder).volumes)
    inside = np.resize(values, cells) if inside is None else inside
    listed = [
        "nonuniform List<scalar> {}({})".format(len(v), " ".join(map(repr, map(float, v)))) for v in (inside, values)
    ]
    foam_cases.put_field(folder, name, listed[0], {"all": f"type fixedValue; value {listed[1]};"})


def test_fields_that_are_uneven_at_the_start_give_their_means(tmp_path, capsys):
    """Not the number of their values, which stands before them: after setFields, or at a later time."""
    cube = tetrahedra(tmp_path / "cube")
    foam_cases.put(cube, "constant/phaseProperties", foam_cases.PHASES)
    foam_cases.put(cube, "constant/thermophysicalProperties.air", foam_cases.THERMO_AIR)
    foam_cases.put(cube, "constant/thermophysicalProperties.particles", foam_cases.THERMO_PARTICLES)
    foam_cases.put_field(cube, "U.air", "uniform (0 0 0)", {"all": "type pressureInletOutletVelocity;"})
    cells = len(volumes := poly_mesh.PolyMesh(cube).volumes)
    hot = np.where(np.arange(cells) < cells // 2, 400.0, 300.0)
    uneven(cube, "T.air", [310.0, 330.0], hot)
    uneven(cube, "T.particles", [300.0], hot)
    uneven(cube, "alpha.particles", [0.0], np.where(hot > 350.0, 0.3, 0.1))
    uneven(cube, "p_rgh", [2.0e5, 2.2e5], np.full(cells, 2.0e5) + 2e3 * (hot > 350.0))
    table, told = adopted(cube, tmp_path / "mine"), capsys.readouterr().out
    mass = np.where(hot > 350.0, 0.3, 0.1) * volumes
    assert table["gas"]["temperature_K"] == pytest.approx(hot.mean())
    assert table["gas"]["operating_pressure_Pa"] == pytest.approx(2.0e5 + 2e3 * (hot > 350.0).mean())
    assert table["particles"]["bed"]["temperature_K"] == pytest.approx(mass @ hot / mass.sum())
    assert table["boundaries"]["all"] == {"kind": "pressure_outlet", "pressure_Pa": 0.0, "temperature_K": 320.0}
    for word in (
        "gas: T is uneven",
        "T.particles is uneven",
        "boundaries.all: p is uneven there",
        "; T is uneven there",
    ):
        assert word in told


@pytest.mark.parametrize(("given", "said"), [
    ({"inlet": "type zeroGradient;"}, False), ({"outlet": "type zeroGradient;"}, True), (None, False),
])  # fmt: skip
def test_a_patch_that_the_temperature_forgot_is_told(tmp_path, capsys, given, said):
    """A field T without an entry for the patch; without any T the gas has one temperature."""
    cube = tetrahedra(tmp_path / "cube")
    boundary = cube / "constant/polyMesh/boundary"
    boundary.write_text(boundary.read_text().replace("all", "inlet"))
    foam_cases.put_field(cube, "U", "uniform (0 0 0)", {"inlet": "type fixedValue; value uniform (0 0 1);"})
    if given:
        foam_cases.put_field(cube, "T", "uniform 300", given)
    adopted(cube, tmp_path / "mine")
    assert ("T is not given there" in capsys.readouterr().out) == said


def test_an_outlet_whose_pressure_is_not_known_has_the_least_of_all():
    """Not zero, which lies an atmosphere below that of others."""
    given = {"a": 1.2e5, "b": None, "c": 1.0e5}
    found = conditions._relative({name: conditions.Condition({"pressure_Pa": p}) for name, p in given.items()})
    assert {name: own.entries["pressure_Pa"] for name, own in found.items()} == {"a": 2e4, "b": 0.0, "c": 0.0}
    listed = ["nonuniform", "List<scalar>", 2.0]
    assert conditions._read("p", [*listed, [1.0, 2.0]]) == (1.5, "p is uneven there: its mean is taken")
    assert conditions._read("p", listed) == (None, "p is not known there: choose it")  # of a binary file
    assert conditions._read("p", ["uniform", 2.0]) == (2.0, "")
