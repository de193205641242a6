"""Cases for tests of case.toml."""

import tomllib

import pytest
from builders import DISC, disc

from sdph.case import read as cases
from sdph.schema import CaseError

TABLE = tomllib.loads(DISC.read_text(encoding="utf-8"))


def refusal(*overrides) -> str:
    """The message with which the disc is refused under overrides."""
    with pytest.raises(CaseError) as caught:
        disc(*overrides)
    message = str(caught.value)
    assert len(message.splitlines()) == 1
    return message


def read_back(case):
    return cases.from_table(tomllib.loads(cases.dumps(case)))
