"""How fast gas crosses the cells of a mesh, foretold by its flow without eddies."""

import numpy as np
import own_meshes
import pytest
from foam_cases import fluidised_bed

from coupling.openfoam import poly_mesh
from sdph import scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.running.driver import template_of
from sdph.study import crossing, rehearsal
from sdph.study.explain import pace
from tests.coupling.openfoam.test_cell_sizes import row

BED = scenes.HERE / "bubbling_bed" / "case.toml"
SPEED = 0.5


def case_of(**boundaries):
    return cases.from_table(cases.parsed(BED) | {"boundaries": boundaries, "probes": {}})


def blown(speed=SPEED):
    return {"kind": "velocity_inlet", "velocity_m_s": [speed, 0.0], "temperature_K": 300.0}


OPEN = {"kind": "pressure_outlet", "pressure_Pa": 0.0, "temperature_K": 300.0}


def pipe(widths):
    """A row of cells that gas goes through from left to right."""
    mesh, count = row(widths), len(widths)
    patch = {"left": slice(count - 1, count), "right": slice(count, count + 1), "wall": slice(count + 1, None)}
    mesh.patches = {name: poly_mesh.Patch("patch", faces) for name, faces in patch.items()}
    mesh.volumes = 0.01 * 0.3 * np.array(widths)
    return mesh


def test_gas_of_a_pipe_crosses_each_cell_in_its_width_over_its_speed():
    widths = [0.01, 0.02, 0.005, 0.04]
    found = crossing.rates(case_of(left=blown(), right=OPEN), pipe(widths))
    assert found == pytest.approx(SPEED / np.array(widths), rel=5e-3)


def test_the_fastest_gas_of_a_pipe_is_that_which_comes_in():
    case, mesh = case_of(left=blown(), right=OPEN), pipe([0.01, 0.02, 0.005, 0.04])
    assert crossing.fastest(mesh, crossing.flow(case, mesh)) == pytest.approx(SPEED, rel=5e-3)
    assert crossing.fastest(mesh, np.zeros(len(mesh.owner))) == 0.0
    one = pipe([0.01])
    assert crossing.fastest(one, crossing.flow(case, one)) == pytest.approx(SPEED, rel=5e-3)


def test_a_cell_has_the_mean_of_what_comes_in_and_goes_out():
    """Through 0.01 m x 0.3 m; 0.1 and 0.3, then 0.3 and 0.2 m3/s."""
    mesh = pipe([0.01, 0.02, 0.005, 0.04])
    through = np.zeros(len(mesh.owner))
    through[:3] = 0.1, 0.3, 0.2
    assert crossing.fastest(mesh, through) == pytest.approx(0.25 / 0.003)


@pytest.mark.parametrize("boundaries", [{"right": OPEN}, {"left": blown()}, {"left": blown(), "beside": OPEN}])
def test_nothing_crosses_where_gas_comes_in_or_goes_out_nowhere(boundaries):
    assert not crossing.rates(case_of(**boundaries), pipe([0.01, 0.02])).any()


def test_only_cells_with_grains_count_and_bubbles_draw_gas_through_them():
    """Twice the speed between the grains, in two dimensions; bubbling_bed has alpha_p = 0.6."""
    case, mesh = case_of(left=blown(), right=OPEN), pipe([0.01, 0.02, 0.005])
    most = crossing.among_grains(case, mesh, np.array([True, True, False]))
    alpha_g = 1.0 - max(region.volume_fraction for region in case.particles.values())
    assert most == pytest.approx(2.0 * SPEED / alpha_g / 0.01, rel=5e-3)
    assert crossing.among_grains(case, mesh, np.zeros(3, bool)) == 0.0


def test_the_window_of_a_mesh_obeys_what_crosses_its_cells():
    case = cases.load(BED)
    scales = judge.scales_of(case)
    assert pace.later(case, scales, 1e5)["courant"] == pytest.approx(1e-5 * case.coupling.courant)
    assert pace.later(case, scales, 1e-3) == pace.later(case, scales)


@pytest.mark.openfoam
def test_gas_of_a_taper_is_slower_where_it_is_wider(tmp_path):
    """3 to 1: by continuity, to the skew of its cells."""
    text = own_meshes.taper(0.1, 0.3, 0.5, 10, 50)
    source = fluidised_bed(tmp_path / "foam", text, "(0 0.25 0)", "(0 -9.81 0)")
    mesh = poly_mesh.PolyMesh(source)
    names = {"inlet": blown() | {"velocity_m_s": [0.0, SPEED]}, "outlet": OPEN}
    found = crossing.rates(case_of(**names), mesh).reshape(50, 10)
    assert found[0].mean() == pytest.approx(SPEED / 0.01, rel=0.02)
    assert found[-1].mean() == pytest.approx(SPEED / 3.0 / 0.01, rel=0.05)
    turned = {"outlet": blown() | {"velocity_m_s": [0.0, -SPEED]}, "inlet": OPEN}
    case = case_of(**turned)
    assert crossing.fastest(mesh, crossing.flow(case, mesh)) == pytest.approx(3.0 * SPEED, rel=0.05)


@pytest.mark.openfoam
def test_windows_of_a_bed_around_a_tube_are_those_of_its_small_cells():
    """A run takes 1137: the cells that gas of twice the speed goes through around the tube are half as
    wide. Of the box alone they would be 400."""
    case = cases.load(scenes.find("bed_with_tube")[1])
    with rehearsal.rehearsed(case, template_of(case, "bed_with_tube")) as (seen, mesh, _):
        crossed = rehearsal.priced(seen, mesh).crossed
    found = pace.later(case, judge.scales_of(case), crossed)
    assert min(found, key=found.get) == "courant"
    assert case.run.end_time / found["courant"] == pytest.approx(1137, rel=0.3)
