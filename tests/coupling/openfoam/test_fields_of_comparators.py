"""Fields of stock OpenFOAM: read in each form, of their own mesh alone."""

import numpy as np
import pytest

from coupling.gas import GasError
from coupling.openfoam import fields

HEADS = {
    "ascii": b"FoamFile { format ascii; }\n",
    "binary": b'FoamFile { format      binary; arch "LSB;label=32;scalar=64"; }\n',
}


def test_fields_are_read_in_each_form(tmp_path):
    file, values = tmp_path / "field", np.arange(6.0).reshape(2, 3)
    bodies = {
        "ascii": b"internalField nonuniform List<vector> \n2\n(\n(0 1 2)\n(3 4 5)\n)\n;\n",
        "binary": b"internalField nonuniform List<vector> \n2\n(" + values.tobytes() + b")\n;\n",
    }
    for form, body in bodies.items():
        file.write_bytes(HEADS[form] + body)
        assert np.array_equal(fields.read(file, 2), values)
    stress = b"internalField nonuniform List<symmTensor> 1((1 2 3 4 5 6));\n"
    file.write_bytes(HEADS["ascii"] + stress)
    assert np.array_equal(fields.read(file, 1), [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]])
    file.write_bytes(HEADS["ascii"] + b"internalField uniform 2.5;\n")
    assert np.array_equal(fields.read(file, 3), [2.5, 2.5, 2.5])
    file.write_bytes(HEADS["ascii"] + b"internalField uniform (1 2 3);\n")
    assert np.array_equal(fields.read(file, 2), [[1.0, 2.0, 3.0]] * 2)


def test_a_field_of_another_mesh_is_refused(tmp_path):
    file = tmp_path / "field"
    file.write_bytes(HEADS["ascii"] + b"internalField nonuniform List<scalar> 2(1 2);\n")
    with pytest.raises(GasError, match="2 values for a mesh of 3 cells"):  # of which the command makes one line
        fields.read(file, 3)


@pytest.mark.parametrize(
    ("body", "values"),
    [
        (b"3{0.5}", [0.5, 0.5, 0.5]),
        (b"2{(1 2 3)}", [[1.0, 2.0, 3.0]] * 2),
        (b"3\n(\n1\n2\n3\n)", [1.0, 2.0, 3.0]),
        (b"1\n(\n(1 2 3)\n)", [[1.0, 2.0, 3.0]]),
        (b"2((0 1 2) (3 4 5))", [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]]),
    ],
)
def test_parcels_are_read_in_each_form(tmp_path, body, values):
    """Of one value for all OpenFOAM writes it once: droplets at rest, a parallel nozzle."""
    file = tmp_path / "U"
    file.write_bytes(HEADS["ascii"] + b"// * * * //\n\n" + body + b"\n\n// *** //\n")
    assert np.array_equal(fields.read_parcels(file), values)
