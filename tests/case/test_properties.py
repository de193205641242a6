"""Answers of CoolProp that are kept on disk are those that it gives, and harm nobody where they cannot be."""

import importlib.metadata

import CoolProp.CoolProp
import pytest

from sdph.case import properties
from sdph.case.properties import Library, Missing

ASKED = ("D", "T", 300.1, "P", 101325.0, "Water")


@pytest.fixture
def nobody(monkeypatch):
    """A CoolProp that may not be asked."""

    def refuse():
        raise AssertionError("asked anew")

    return lambda: monkeypatch.setattr(properties, "_imported", refuse)


def test_what_was_asked_once_is_known_to_the_last_bit(tmp_path, nobody):
    first = Library(tmp_path).PropsSI(*ASKED)
    assert first == CoolProp.CoolProp.PropsSI(*ASKED)
    Library(tmp_path).get_fluid_param_string("Water", "formula")
    nobody()
    assert Library(tmp_path).PropsSI(*ASKED) == first
    assert Library(tmp_path).get_fluid_param_string("Water", "formula") == "H_{2}O_{1}"
    with pytest.raises(AssertionError, match="asked anew"):
        Library(tmp_path).PropsSI("D", "T", 300.2, *ASKED[3:])


def test_another_version_is_asked_anew(tmp_path, monkeypatch, nobody):
    Library(tmp_path).PropsSI(*ASKED)
    monkeypatch.setattr(importlib.metadata, "version", lambda name: "0.0")
    nobody()
    with pytest.raises(AssertionError, match="asked anew"):
        Library(tmp_path).PropsSI(*ASKED)


@pytest.mark.parametrize("damage", ["", "{", "5", "[1]", '"text"', b"\xff"])
def test_a_damaged_file_is_made_anew(tmp_path, damage):
    own = Library(tmp_path)
    value = own.PropsSI(*ASKED)
    own.file.write_bytes(damage if isinstance(damage, bytes) else damage.encode())
    assert Library(tmp_path).PropsSI(*ASKED) == value
    assert Library(tmp_path).known


def test_a_folder_that_cannot_be_is_no_harm_and_refusals_are_not_kept(tmp_path):
    (tmp_path / "file").write_text("")
    own = Library(tmp_path / "file")
    assert own.PropsSI(*ASKED) > 990.0
    before = dict(own.known)
    with pytest.raises(ValueError):
        own.PropsSI("D", "T", -5.0, *ASKED[3:])
    assert own.known == before


def test_a_library_that_is_not_there_is_told(tmp_path, monkeypatch):
    def absent(name):
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "version", absent)
    with pytest.raises(Missing):
        Library(tmp_path)
