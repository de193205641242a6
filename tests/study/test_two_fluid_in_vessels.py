"""Two fluids on meshes that are no boxes: what turning the vessel changes, what is refused, a scene from end to end."""

from math import cos, pi, sin

import numpy as np
import pytest

from coupling.openfoam import fields, poly_mesh
from coupling.openfoam.comparators import run as comparators
from coupling.openfoam.comparators.start import Start
from coupling.openfoam.programs import barrier
from coupling.openfoam.programs import run as programs
from sdph.case import read as cases
from sdph.cli import main
from sdph.schema import CaseError
from sdph.study import two_fluid
from tests.coupling.openfoam.own_meshes import turned_box

SIZE, CELLS = (0.1, 0.24), (10, 12)  # m, and cells of 10 x 20 mm: products of fields go wrong on these once turned
CONTROL = "FoamFile { version 2.0; format ascii; class dictionary; object controlDict; }\n" + "".join(
    f"{key} {value};\n" for key, value in (("application", "blockMesh"), ("startFrom", "startTime"), ("startTime", 0),
    ("stopAt", "endTime"), ("endTime", 1), ("deltaT", 1), ("writeControl", "timeStep"), ("writeInterval", 1))
)  # fmt: skip


BED = {  # of whom only the temperature counts: a start tells how grains stand
    "shape": "box", "lower_m": [0.0, 0.1], "upper_m": [0.1, 0.2], "volume_fraction": 0.55, "temperature_K": 300.0,
}  # fmt: skip


def case(angle: float, end: float = 0.03):
    """A bed in a plane vessel that is turned, gravity and what blows in with it."""
    up = np.array([-sin(angle), cos(angle)])
    return cases.from_table({
        "title": "turned", "dimensions": 2,
        "effects": ["drag", "gas_pressure", "gravity", "granular_pressure", "friction", "granular_temperature"],
        "run": {"end_time_s": end, "output_interval_s": end},
        "domain": {"lower_m": [-0.2, 0.0], "size_m": [0.4, 0.4], "gravity_m_s2": (-9.81 * up).tolist()},
        "resolution": {"spacing_mm": 5.0, "cell_mm": 14.0},
        "gas": {
            "equation_of_state": "constant", "density_kg_m3": 1.2, "viscosity_Pa_s": 1.8e-5,
            "conductivity_W_m_K": 0.024, "heat_capacity_J_kg_K": 1006.0, "temperature_K": 300.0,
        },
        "grains": {
            "density_kg_m3": 2500.0, "diameter_mm": 0.5, "heat_capacity_J_kg_K": 840.0, "conductivity_W_m_K": 1.0,
        },
        "particles": {"bed": BED},
        "boundaries": {
            "inlet": {"kind": "velocity_inlet", "velocity_m_s": (0.5 * up).tolist(), "temperature_K": 300.0},
            "outlet": {"kind": "pressure_outlet", "pressure_Pa": 0.0, "temperature_K": 300.0},
        },
    })  # fmt: skip


def meshed(folder, angle: float):
    """An OpenFOAM case with the mesh of the turned vessel, and no more."""
    for part in ("system", "constant"):
        (folder / part).mkdir(parents=True)
    (folder / "system" / "controlDict").write_text(CONTROL, encoding="utf-8")
    (folder / poly_mesh.BLOCKS).write_text(turned_box(*SIZE, *CELLS, angle), encoding="utf-8")
    programs.run(["blockMesh"], folder, folder / "log", barrier.environment())
    return folder


def two_fluids(folder, angle: float):
    """alpha_p (C,) of a bed with a bubble at its side after 0.03 s, and the run."""
    x, y = np.meshgrid(*((np.arange(n) + 0.5) * size / n for n, size in zip(CELLS, SIZE)))
    x, y = x.ravel(), y.ravel()
    bed = np.where((y < 0.12) & (np.hypot(x - 0.03, y - 0.06) > 0.025), 0.55, 0.0)
    places = np.column_stack((x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle)))
    start = Start(places, bed, np.zeros((len(bed), 3)), np.full(len(bed), 300.0), meshed(folder / "gas", angle))
    found = comparators.run_two_fluid(case(angle), folder / "tfm", start=start)
    return found.fields[max(found.fields)]["alpha_p"], found


@pytest.fixture
def shelf(tmp_path, monkeypatch):
    monkeypatch.setattr(comparators, "shelf", lambda: tmp_path / "references")


@pytest.mark.openfoam
def test_a_turned_vessel_has_the_same_bed(tmp_path, shelf):
    """OpenFOAM as it is packaged ends in a floating point exception here, with 1.2 of grains in a cell before."""
    upright, first = two_fluids(tmp_path / "upright", 0.0)
    turned, second = two_fluids(tmp_path / "turned", pi / 6.0)
    assert turned @ second.volumes == pytest.approx(upright @ first.volumes, rel=1e-6)
    assert turned.max() == pytest.approx(upright.max(), abs=2e-3)
    assert np.abs(turned - upright).max() < 0.1  # limiters act by component, at the edge of the bubble


@pytest.mark.openfoam
def test_another_mesh_is_another_reference(tmp_path):
    empty = np.zeros((1, 2)), np.zeros(1), np.zeros((1, 3)), np.zeros(1)
    digests = {Start(*empty, meshed(tmp_path / str(angle), angle)).digest for angle in (0.0, 0.1)}
    assert len(digests | {Start(*empty).digest}) == 3


@pytest.mark.openfoam
def test_a_mesh_that_runs_code_is_refused(tmp_path, shelf):
    """A run folder may come from elsewhere."""
    mesh = meshed(tmp_path / "gas", 0.0)
    path = mesh / poly_mesh.FOLDER / "boundary"
    path.write_text(path.read_text(encoding="utf-8") + '#calc "1"\n', encoding="utf-8")
    start = Start(np.zeros((1, 2)), np.zeros(1), np.zeros((1, 3)), np.full(1, 300.0), mesh)
    with pytest.raises(CaseError, match="calc"):
        comparators.run_two_fluid(case(0.0), tmp_path / "tfm", start=start)


@pytest.mark.openfoam
@pytest.mark.parametrize("scene", ["tapered_bed", "cylindrical_bed"])
def test_a_vessel_of_its_own_mesh_runs_beside_two_fluids(scene, tmp_path, shelf, capsys):
    folder = tmp_path / "run"
    assert main(["run", scene, "--until", "0.04", "--out", str(folder)]) == 0
    capsys.readouterr()
    assert main(["compare", str(folder), "--against", "tfm"]) in (0, 1)
    said = capsys.readouterr().out
    for name in ("mass of the grains", "middle of the grains", "grains that stand in other cells"):
        assert next(line for line in said.splitlines() if line.startswith(name)).endswith("ok")
    assert (folder / two_fluid.PICTURE).stat().st_size > 10_000
    cells = fields.cell_count(folder / "gas")
    begun = fields.read(folder / "tfm/0/alpha.particles", cells)
    assert begun.max() < 0.63 and begun @ fields.read(folder / "tfm/0/V", cells) > 0.0
    assert "non_orthogonal corrected" in (folder / "tfm/constant/sdphTwoFluid").read_text(encoding="utf-8")
