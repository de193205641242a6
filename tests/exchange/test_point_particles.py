"""Gas that knows nothing of the volume of grains has all of its cells, in the exchange too."""

import pytest
from char_boxes import char, started


def test_grains_take_no_room_of_a_gas_that_does_not_know_of_it(tmp_path):
    """Of what grains strip the share that a cell loses in a second: with half of the cell full, of twice the rest."""
    shares = {}
    for voidage in (True, False):
        (tmp_path / str(voidage)).mkdir()
        run = started(char(alpha_p=0.5, coupling={"one_way": False, "voidage": voidage}), tmp_path / str(voidage))
        shares[voidage] = run.exchange.pace(run.state, run.weights, run.gas_state)[2][0]
        assert run.cell_fields()["alpha_p"][0] == pytest.approx(0.5)
    assert 0.0 < shares[False] == pytest.approx(0.5 * shares[True])
