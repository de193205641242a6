"""State that a run keeps: taken apart for a file, checked when it comes back, and put into its place.

A class that changes as a run goes names its attributes that do so,

    KEPT = ("time", "windows", "stepper")

and each of them is an array, a number, a text, None, a random generator, a tuple, list or dict of these, or an object
with KEPT in turn. What comes back has to be of the form that a fresh object has: the same names, types, lengths and
shapes, every number finite. Attributes whose fresh value does not tell their form are named with it,

    FORMS = {"state": GROWING, "rates": Maybe((0.0, np.zeros(0)))}

and what only the class itself can judge it refuses in `admit(kept)`, by `Unfit`. Nothing is set before all has been
checked. What follows from the kept is not kept: a class that has to make it anew does so in `revive()`, which is called
once its attributes are back. An effect with a memory of its own keeps it in arrays of the State, or in an object that
is named in the KEPT of the one which owns it; nothing else is to be done.
"""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass

import numpy as np

LARGEST = 2**63  # of a whole number
QUOTES = "'\""


class Unfit(ValueError):
    """Kept values that do not fit into their place: which, and why, in one line."""


class OtherVersion(Unfit):
    """Kept values whose names are not those of this version."""


@dataclass(frozen=True)
class Maybe:
    """None, or of the form of `like`."""

    like: object

    def check(self, fresh, value, where: str) -> None:
        if value is not None:
            check(self.like, value, where, free=True)


@dataclass(frozen=True)
class Many:
    """A list or tuple of any length, each part of the form of `like`."""

    like: object

    def check(self, fresh, value, where: str) -> None:
        _expect(isinstance(value, list), where, "is no list")
        for i, part in enumerate(value):
            check(self.like, part, f"{where}.{i}", free=True)


@dataclass(frozen=True)
class Named:
    """Values by name, each of the form of `like`."""

    like: object

    def check(self, fresh, value, where: str) -> None:
        _expect(isinstance(value, dict), where, "is no table")
        for key, part in value.items():
            _text(key, where)
            check(self.like, part, f"{where}.{key}", free=True)


class Growing:
    """The form of the fresh value, its arrays of any length."""

    def check(self, fresh, value, where: str) -> None:
        check(fresh, value, where, free=True)


class Positive:
    """A number above 0, infinity too."""

    def check(self, fresh, value, where: str) -> None:
        _expect(isinstance(value, float) and value > 0.0, where, f"is {short(value)}; it must be a number above 0")


class Cell:
    """A number, one that is none too (NaN), or a text: what stands in a table."""

    def check(self, fresh, value, where: str) -> None:
        if isinstance(value, str):
            _text(value, where)
        elif not isinstance(value, float):
            _whole(value, where)


GROWING, POSITIVE = Growing(), Positive()
ROW = Named(Cell())  # of a table
FORM = (Maybe, Many, Named, Growing, Positive, Cell)


def pack(value, arrays: dict):
    """A value as JSON can hold it; arrays go to `arrays`, numbered: a key may be a text that a file cannot be
    called."""
    if isinstance(value, np.ndarray):
        arrays[name := str(len(arrays))] = value
        return {"array": name}
    if isinstance(value, np.random.Generator):
        return value.bit_generator.state
    if isinstance(value, np.generic):
        return value.item()
    parts = _parts(value)
    if parts is not None:
        return {key: pack(part, arrays) for key, part in parts.items()}
    if isinstance(value, (list, tuple)):
        return [pack(part, arrays) for part in value]
    return value


def unpack(saved, arrays: dict):
    """The same with its arrays back, which are taken out of `arrays`, each once."""
    if isinstance(saved, list):
        return [unpack(part, arrays) for part in saved]
    if not isinstance(saved, dict):
        return saved
    if saved.keys() != {"array"}:
        return {key: unpack(part, arrays) for key, part in saved.items()}
    name = saved["array"]
    if not isinstance(name, str) or name not in arrays:
        raise Unfit(f"array {short(name)} is named, but is not there or named twice")
    return arrays.pop(name)


def _parts(value) -> dict | None:
    """Name -> value of what has named parts."""
    if hasattr(value, "KEPT"):
        return {name: getattr(value, name) for name in value.KEPT}
    if hasattr(value, "_asdict"):
        return value._asdict()
    return value if isinstance(value, dict) else None


def check(like, value, where: str, free: bool = False) -> None:
    """`Unfit` where `value` is not of the form of `like`, a fresh value or a FORM; arrays of any length where
    `free`."""
    if isinstance(like, FORM):
        like.check(None, value, where)
    elif isinstance(like, np.ndarray):
        _array(like, value, where, free)
    elif isinstance(like, np.random.Generator):
        _generator(like, value, where)
    elif (parts := _parts(like)) is not None:
        _named(like, parts, value, where, free)
    elif isinstance(like, (list, tuple)):
        _expect(
            isinstance(value, list) and len(value) == len(like),
            where,
            f"is {short(value)}; a list of {len(like)} was expected",
        )
        for i, (part, own) in enumerate(zip(value, like)):
            check(own, part, f"{where}.{i}", free)
    else:
        _single(like, value, where)


def _named(like, parts: dict, value, where: str, free: bool) -> None:
    _expect(isinstance(value, dict), where, f"is {short(value)}; a table was expected")
    if parts.keys() != value.keys():
        raise OtherVersion(f"{where} differs in {short(', '.join(sorted(parts.keys() ^ value.keys()))).strip(QUOTES)}")
    forms = getattr(like, "FORMS", {})
    for key, own in parts.items():
        if key in forms:
            forms[key].check(own, value[key], f"{where}.{key}")
        else:
            check(own, value[key], f"{where}.{key}", free)
    if hasattr(like, "admit"):
        like.admit(value)


def _array(like, value, where: str, free: bool) -> None:
    _expect(isinstance(value, np.ndarray), where, f"is {short(value)}; an array was expected")
    same = value.shape[1:] == like.shape[1:] if free and value.ndim == like.ndim else value.shape == like.shape
    if value.dtype != like.dtype or not same:
        form = f"{like.dtype} of shape {('any', *like.shape[1:]) if free else like.shape}"
        raise Unfit(f"{where} is {value.dtype} of shape {value.shape}; {form} was expected")
    _expect(bool(np.isfinite(value).all()), where, "is not finite everywhere")


def _single(like, value, where: str) -> None:
    if like is None:
        _expect(value is None, where, f"is {short(value)}; nothing was expected")
    elif isinstance(like, (bool, np.bool_)):
        _expect(isinstance(value, bool), where, f"is {short(value)}; true or false was expected")
    elif isinstance(like, str):
        _text(value, where)
    elif isinstance(like, (float, np.floating)):
        _expect(
            isinstance(value, float) and math.isfinite(value), where, f"is {short(value)}; a finite number was expected"
        )
    else:
        _whole(value, where)


def _whole(value, where: str) -> None:
    fine = isinstance(value, int) and not isinstance(value, bool) and -LARGEST <= value < LARGEST
    _expect(fine, where, f"is {short(value)}; a whole number was expected")


def _text(value, where: str) -> None:
    # halves of letters cannot be written
    fine = isinstance(value, str) and not any("\ud800" <= letter <= "\udfff" for letter in value)
    _expect(fine, where, f"is {short(value)}; a text was expected")


def _generator(like, value, where: str) -> None:
    """Check the state of a random generator by trying it on a copy: numpy knows best what its generators take."""
    _expect(isinstance(value, dict), where, "is no state of a random generator")
    try:
        trial = copy.deepcopy(like)
        trial.bit_generator.state = value
        fits = trial.bit_generator.state == value
    except Exception:  # numpy lets through whatever goes wrong in its parts
        fits = False
    _expect(fits, where, f"is no state of the random generator {type(like.bit_generator).__name__}")


def _expect(fine: bool, where: str, wrong: str) -> None:
    if not fine:
        raise Unfit(f"{where} {wrong}")


def short(value) -> str:
    """A value from a file that is not trusted, short enough for a line, without control characters."""
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}"
    if isinstance(value, (dict, list)):
        return f"a {'table' if isinstance(value, dict) else 'list'} of {len(value)}"
    text = ascii(value) if not isinstance(value, int) or abs(value) < LARGEST else "a number of many digits"
    return text if len(text) <= 60 else f"{text[:57]}..."


def put(like, value):
    """Put checked values in the place of `like`: an object that has KEPT is filled, anything else is made anew."""
    if isinstance(like, np.random.Generator):
        like.bit_generator.state = value
        return like
    if isinstance(value, list):
        parts = [put(None, part) for part in value]
        return parts if isinstance(like, list) else tuple(parts)
    if not isinstance(value, dict):
        return value
    known = _parts(like) or {}
    parts = {key: put(known.get(key), part) for key, part in value.items()}
    if hasattr(like, "_asdict"):
        return type(like)(**parts)
    return _filled(like, parts) if hasattr(like, "KEPT") else parts


def _filled(like, parts: dict):
    for key, part in parts.items():
        setattr(like, key, part)
    if hasattr(like, "revive"):
        like.revive()
    return like
