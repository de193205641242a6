"""What sdphGasFoam does not do, or would do wrong, in a case with files of one's own: refused in a line."""

import re
import shutil

import pytest
from gas_boxes import TEMPLATE, box_case
from test_gas_process import INLET

from coupling.gas import GasError
from coupling.openfoam.case import write_start_fields
from coupling.openfoam.solver import OpenFoamGas
from sdph.schema import CaseError

pytestmark = pytest.mark.openfoam


def brought(folder, **texts):
    """A case with files of its own, names with __ for slashes."""
    shutil.copytree(TEMPLATE, folder)
    for name, text in texts.items():
        path = folder / name.replace("__", "/")
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    return folder


HEADER = "FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"
LEAKING = HEADER.format(kind="volScalarField", name="p_rgh") + (
    "dimensions [1 -1 -2 0 0 0 0];\ninternalField uniform 0;\n"
    'boundaryField { outlet { type fixedValue; value uniform 0; } ".*" { type zeroGradient; } }\n'
)
OTHER = HEADER.format(kind="dictionary", name="gasProperties") + '#include "sdphCase"\ndomain_gravity (0 -9.81 0);\n'
CONTROL = (TEMPLATE / "system" / "controlDict").read_text()


@pytest.mark.parametrize(("texts", "error", "says"), [
    ({"0__p_rgh": LEAKING}, GasError, "0/p_rgh: patch inlet is zeroGradient; give fixedFluxPressure"),
    ({"constant__gasProperties": OTHER}, CaseError, "domain_gravity_y = -9.81; case.toml has 0.0"),
    ({"constant__fvOptions": "heater { type none; }"}, CaseError, "fvOptions: sdphGasFoam has no sources of its own"),
    ({"system__controlDict": CONTROL + "functions { mine { type probes; } }"}, CaseError, "calls no functions"),
])  # fmt: skip
def test_what_the_gas_would_not_do_is_refused(tmp_path, texts, error, says):
    template = brought(tmp_path / "template", **texts)
    with pytest.raises(error, match=says):
        OpenFoamGas(box_case((0.1, 0.06), 0.005, boundaries=INLET), tmp_path / "gas", template).close()


def test_a_gas_that_begins_later_is_refused(tmp_path):
    late = re.sub(r"startTime\s+\S+;", "startTime 0.5;", CONTROL)
    assert late != CONTROL
    case = box_case((0.1, 0.06), 0.005, boundaries=INLET)
    template = brought(tmp_path / "template", system__controlDict=late)
    write_start_fields(case, template)
    (template / "0").rename(template / "0.5")
    gas = OpenFoamGas(case, tmp_path / "gas", template)
    with pytest.raises(CaseError, match=r"the gas begins at 0.5 s; give startFrom startTime and startTime 0"):
        gas.start(None, ())
