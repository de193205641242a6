"""What the gas solver says comes to the user as one line of bounded length, whatever is in it."""

import threading

import pytest

from coupling.gas import GasError, Unfinished
from coupling.openfoam.links import Links
from coupling.openfoam.solver import OpenFoamGas
from coupling.transport.files import FileConnection
from coupling.transport.messages import Kind, Message
from sdph.engine.reading import LINE

NASTY = "hot\n\x1b[31mred\x00\r\n\u2028end " + "x" * 10**5


@pytest.fixture
def gas(tmp_path):
    """Makes a gas whose solver, a thread, answers the next message by one of `kind` with `text`."""

    def answering(kind, text):
        gas = OpenFoamGas.__new__(OpenFoamGas)
        gas._log, gas._process, gas._fields, gas._heard = tmp_path / "log", None, (), True
        gas._links, gas._connection = Links(), FileConnection(tmp_path / "exchange")
        gas._watch = lambda: lambda: True
        gas._say_goodbye = lambda: None
        solver = FileConnection(tmp_path / "exchange", "to_sdph", "to_gas")
        threading.Thread(
            target=lambda: (solver.receive(10.0), solver.send(Message(kind, {"text": text}))), daemon=True
        ).start()
        return gas

    return answering


@pytest.mark.parametrize("kind, error", [(Kind.UNFINISHED, Unfinished), (Kind.ERROR, GasError)])
def test_what_the_solver_says_is_one_line(gas, tmp_path, kind, error):
    with pytest.raises(error) as told:
        gas(kind, NASTY).retreat()
    line, about = str(told.value), f"sdphGasFoam says:  (log: {tmp_path}/log)"
    assert line.isprintable() and len(line) <= LINE + len(" [...] ") + len(about)
    assert line.startswith(r"sdphGasFoam says: hot \x1b[31mred\x00 end xxx")


@pytest.mark.parametrize("text", [3.0, ""])
def test_what_says_nothing_is_no_harm(gas, text):
    with pytest.raises(Unfinished, match="sdphGasFoam says: "):
        gas(Kind.UNFINISHED, text).retreat()
