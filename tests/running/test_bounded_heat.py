"""Gas that passes a cold wall on cells that are no boxes stays within the temperatures that there are."""

import foam_cases
import own_meshes
import pytest
import pyvista

from sdph.cli import main

CASE = """title = "Hot gas through a converging channel with cold walls"
dimensions = 2
effects = []
[run]
end_time_s = 0.02
output_interval_s = 0.005
[domain]
gravity_m_s2 = [0.0, 0.0]
[resolution]
spacing_mm = 10.0
cell_mm = 7.0
[gas]
equation_of_state = "operating"
density_kg_m3 = 6.7
viscosity_Pa_s = 8e-5
conductivity_W_m_K = 0.25
heat_capacity_J_kg_K = 1900.0
temperature_K = 3000.0
molar_mass_kg_kmol = 28.0
operating_pressure_Pa = 6e6
[grains]
density_kg_m3 = 2700.0
diameter_mm = 0.03
heat_capacity_J_kg_K = 1850.0
conductivity_W_m_K = 6.0
[boundaries.inlet]
kind = "velocity_inlet"
velocity_m_s = [0.0, 10.0]
temperature_K = 3000.0
[boundaries.outlet]
kind = "pressure_outlet"
temperature_K = 3000.0
[boundaries.wall]
kind = "wall"
temperature_K = 2200.0
"""


@pytest.mark.openfoam
def test_gas_gets_no_hotter_than_what_comes_in(tmp_path):
    flat = ("type empty;",) * 2
    conditions = {
        "inlet": ("type fixedValue; value uniform (0 10 0);", "type zeroGradient;"),
        "outlet": ("type zeroGradient;", "type fixedValue; value uniform 0;"),
        "wall": ("type noSlip;", "type zeroGradient;"),
        "frontAndBack": flat,
    }
    source = foam_cases.gas_alone(tmp_path / "foam", own_meshes.taper(0.2, 0.04, 0.1, 12, 12), conditions)
    assert main(["init", "--from-openfoam", str(source), str(tmp_path / "mine")]) == 0
    (tmp_path / "mine/case.toml").write_text(CASE)
    assert main(["run", str(tmp_path / "mine"), "--out", str(tmp_path / "run")]) == 0
    fields = [pyvista.read(file)["temperature"] for file in sorted(tmp_path.glob("run/fields/gas_*"))[1:]]
    assert fields and all(field.min() >= 2200.0 and field.max() < 3000.03 for field in fields)
