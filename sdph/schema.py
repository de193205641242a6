"""Dataclasses read from and written to TOML: units in the key names, and errors that help.

A field is declared `spacing: float = quantity("mm", above=0.0)`; in TOML its key is `spacing_mm`, in Python
the attribute `spacing` holds SI. `choice`, `flag`, `words`, `file` and `vector` declare the other kinds of value.
"""

from __future__ import annotations

import dataclasses
import difflib
import math
import sys
from pathlib import Path
from typing import Any

# unit as written in a key -> factor to SI
UNITS = {
    "": 1.0, "s": 1.0, "ms": 1e-3, "us": 1e-6, "m": 1.0, "mm": 1e-3, "um": 1e-6, "K": 1.0, "Pa": 1.0,
    "deg": math.pi / 180.0, "kg_m3": 1.0, "Pa_s": 1.0, "W_m_K": 1.0, "J_kg_K": 1.0, "J_kg": 1.0, "m_s": 1.0,
    "m_s2": 1.0, "m2_s": 1.0, "m2_s2": 1.0, "kg_kmol": 1.0, "kg_s": 1.0, "N_m": 1.0, "Pa_m6_kg2": 1.0, "rad_s": 1.0,
    "kg": 1.0, "Hz": 1.0, "1_s": 1.0, "W_m2": 1.0, "V_m": 1.0, "C_m2": 1.0, "m2_s3": 1.0,
}  # fmt: skip
SAME_AS = {"ms": "s", "us": "s", "mm": "m", "um": "m"}  # unit -> the one that its bounds stand under

# Unit -> least (of what must be above 0) and most in SI, and what lies there. Our choice, so wide that they catch slips
# of the exponent or the unit and nothing that anybody means: beyond them sums of squares lose all digits or overflow.
PLAUSIBLE = {
    "": (1e-15, 1e30, "less than round-off, or no number to compute with"),
    "deg": (0.0, math.tau, "a full turn"),
    "s": (0.0, 1e12, "30 000 years"),
    "Hz": (0.0, 1e18, "X-rays"),
    "1_s": (1e-18, 1e15, "from the creep of mountains to a shock of atoms"),
    "rad_s": (0.0, 1e12, "faster than anything turns"),
    "m": (1e-16, 1e10, "from inside a nucleus to beyond the largest planet"),
    "m_s": (1e-15, 299792458.0, "the speed of light"),
    "m_s2": (0.0, 1e12, "the surface of a neutron star"),
    "m2_s": (1e-18, 1e6, "from diffusion in a solid to that in a star"),
    "m2_s2": (1e-18, 1e12, "a speed of 1000 km/s, squared"),
    "m2_s3": (1e-18, 1e18, "more heat than a gram of anything takes in a nanosecond"),
    "kg": (1e-27, 1e27, "from an atom to a planet"),
    "kg_s": (1e-27, 1e15, "from an atom a second to a mountain a second"),
    "kg_m3": (1e-20, 1e6, "from the space between planets to 40 times osmium"),
    "kg_kmol": (0.1, 1e9, "from a tenth of hydrogen to a strand of DNA"),
    "K": (1e-6, 1e8, "from the coldest gas of a laboratory to the middle of a star"),
    "Pa": (1e-15, 1e18, "from the best vacuum to the middle of a star"),
    "Pa_s": (1e-15, 1e25, "from a gas all but without friction to the Earth's mantle"),
    "Pa_m6_kg2": (0.0, 1e9, "a million times that of water"),
    "N_m": (1e-12, 1e6, "from interfaces at their critical point to a million times water"),
    "W_m_K": (1e-9, 1e9, "from a ten-thousandth of the best insulator to a million times copper"),
    "W_m2": (1e-12, 1e20, "from starlight to a focused laser"),
    "V_m": (0.0, 1e12, "the field inside an atom"),
    "C_m2": (0.0, 10.0, "an electron on each atom of a surface"),
    "J_kg": (1e-6, 1e15, "from a fall of a ten-thousandth of a millimetre to nuclear fuel"),
    "J_kg_K": (1e-6, 1e12, "from a metal near 0 K to a bath that nothing warms"),
}


class CaseError(ValueError):
    """A case that cannot be run: what was given, what is allowed, what to do. One line; the command exits with 2."""


record = dataclasses.dataclass(frozen=True, kw_only=True)


@dataclasses.dataclass(frozen=True)
class Kind:
    """Values that a field accepts: its unit, its bounds, and how many components (0: a scalar, None: any number)."""

    unit: str = ""
    above: float = -math.inf
    least: float = -math.inf
    most: float = math.inf
    choices: tuple[str, ...] = ()
    components: int | None = 0
    of: type | None = None
    tiny: bool = False

    def key(self, name: str) -> str:
        return f"{name}_{self.unit}" if self.unit else name


def _declare(kind: Kind, default: Any) -> Any:
    return dataclasses.field(default=default, metadata={"kind": kind})


REQUIRED = dataclasses.MISSING


def quantity(unit="", default=REQUIRED, *, above=-math.inf, least=-math.inf, most=math.inf, tiny=False):
    """A number with a unit and bounds; bounds and default are in that unit too.

    What must be above 0 must also be of a plausible size, unless `tiny` values stand for 0 itself.
    """
    in_si = default if default is REQUIRED or default is None else default * UNITS[unit]
    return _declare(Kind(unit, above, least, most, tiny=tiny), in_si)


def vector(unit="", default=REQUIRED, components=None):
    """A list of numbers with a unit; nested lists too."""
    return _declare(Kind(unit, components=components), default)


def choice(*allowed, default=REQUIRED):
    """One word out of a few."""
    return _declare(Kind(choices=allowed), allowed[0] if default is REQUIRED else default)


def flag(default: bool):
    """true or false."""
    return _declare(Kind(of=bool), default)


def whole(default=REQUIRED, *, least=-math.inf):
    """A whole number."""
    return _declare(Kind(least=least, of=int), default)


def file(default=""):
    """The path of a file, from the folder of the case file; none where it is empty."""
    return _declare(Kind(of=Path), default)


def section(cls: type):
    """A section of its own within this one, of a dataclass declared with this module; None where it is left out."""
    return _declare(Kind(of=cls), None)


def words(default=REQUIRED):
    """A list of texts, or a text, which is a list of one; one text alone where the default is one."""
    return _declare(Kind(of=str, components=0 if isinstance(default, str) else None), default)


def fields(cls: type) -> dict[str, tuple[str, Kind]]:
    """TOML key -> (attribute, kind) of a dataclass declared with this module."""
    own = [f for f in dataclasses.fields(cls) if "kind" in f.metadata]
    return {f.metadata["kind"].key(f.name): (f.name, f.metadata["kind"]) for f in own}


def defaults(cls: type) -> dict[str, Any]:
    """TOML key -> default, in SI units, of the same."""
    return {key: cls.__dataclass_fields__[name].default for key, (name, _) in fields(cls).items()}


def read(cls: type, table: dict, where: str):
    """A dataclass from a TOML table; `where` is the section's name, for messages."""
    if not isinstance(table, dict):
        raise CaseError(f"{where} is {table!r}; it must be a section, [{where}]")
    known, values = fields(cls), {}
    for key, value in table.items():
        if key not in known:
            raise CaseError(unknown(f"{where}.{key}" if where else key, known, where))
        name, kind = known[key]
        values[name] = _value(kind, value, f"{where}.{key}" if where else key)
    _refuse_missing(cls, values, where)
    return cls(**values)


def _refuse_missing(cls: type, values: dict, where: str) -> None:
    for f in dataclasses.fields(cls):
        if f.name not in values and f.default is REQUIRED and f.default_factory is REQUIRED and "kind" in f.metadata:
            key = f.metadata["kind"].key(f.name)
            raise CaseError(f"{where}.{key} is missing; it has no default: give it in [{where}]")


def write(record: Any) -> dict:
    """The TOML table of a dataclass declared with this module; unset (None) fields are left out."""
    pairs = ((key, kind, getattr(record, name)) for key, (name, kind) in fields(type(record)).items())
    return {key: _in_unit(value, UNITS[kind.unit]) for key, kind, value in pairs if value is not None}


def flat(table: dict, prefix: str = "") -> dict:
    """Dotted key -> value of a TOML table."""
    found = {}
    for key, value in table.items():
        found |= flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {prefix + key: value}
    return found


def unknown(given: str, known, where: str = "") -> str:
    """The message for a word that is not known, with the one that lacks but its unit, or else the nearest that is."""
    prefix, word = f"{where}." if where else "", given.rpartition(".")[2]
    longer = sorted((own for own in known if own.startswith(f"{word}_")), key=len)
    near = longer or difflib.get_close_matches(word, list(known), n=1, cutoff=0.4)
    hint = f"did you mean {prefix}{near[0]}?" if near else ""
    return f"unknown key {given}; {hint} known here: {', '.join(sorted(known))}"


def _chosen(kind: Kind, value: Any, key: str) -> Any:
    if value not in kind.choices:
        raise CaseError(f"{key} = {value!r}; allowed: {', '.join(kind.choices)}")
    return value


def _value(kind: Kind, value: Any, key: str) -> Any:
    if kind.choices:
        return _chosen(kind, value, key)
    if dataclasses.is_dataclass(kind.of):
        return read(kind.of, value, key)
    if kind.of is bool:
        return _typed(value, bool, key, "true or false")
    if kind.of is int:
        return int(_bounded(kind, _typed(value, int, key, "a whole number"), key))
    if kind.of is str:
        return _typed(value, str, key, "a text") if kind.components == 0 else _words(value, key)
    if kind.of is Path:
        return _typed(value, str, key, "the path of a file, as a text")
    if kind.components == 0:
        return _bounded(kind, _number(value, key, kind), key) * UNITS[kind.unit]
    return _vector(kind, value, key)


def _typed(value: Any, of: type, key: str, what: str) -> Any:
    if not isinstance(value, of) or (of is int and isinstance(value, bool)):
        raise CaseError(f"{key} = {value!r}; it must be {what}")
    return value


def _words(value: Any, key: str) -> Any:
    if isinstance(value, list) and all(isinstance(v, str) for v in value):
        return tuple(value)
    return (_typed(value, str, key, "a text"),)


def spelled(unit: str) -> str:
    """A unit of keys as one writes it: m/s2 of m_s2; 1 of none."""
    return {"": "1", "Pa_s": "Pa s", "Pa_m6_kg2": "Pa m6/kg2"}.get(unit, unit.replace("_", "/"))


def _number(value: Any, key: str, kind: Kind) -> float:
    unit = spelled(kind.unit)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise CaseError(f"{key} = {value!r}; it must be a number in {unit}, without the unit")
    if not abs(value) <= sys.float_info.max:  # nan, inf, and whole numbers too long for a float
        raise CaseError(f"{key} = {str(value)[:40]}; it must be a finite number in {unit}{_allowed(kind, ', ')}")
    return float(value)


def _bounded(kind: Kind, value: float, key: str) -> float:
    if not (value > kind.above and kind.least <= value <= kind.most):
        raise CaseError(f"{key} = {str(value)[:40]}; it must be {_allowed(kind)}")
    return value


def _allowed(kind: Kind, first: str = "") -> str:
    """The bounds of a number in words, after `first`; empty where it has none."""
    low = ("above", kind.above) if kind.above > -math.inf else ("at least", kind.least)
    bounds = [f"{word} {bound:g}" for word, bound in (low, ("at most", kind.most)) if math.isfinite(bound)]
    return first * bool(bounds) + " and ".join(bounds)


def plausible(record: Any, where: str):
    """The record as it is; `CaseError` where a quantity of it is of no size that makes sense (see PLAUSIBLE)."""
    for key, (name, kind) in fields(type(record)).items():
        if dataclasses.is_dataclass(getattr(record, name)):
            plausible(getattr(record, name), f"{where}.{key}")
        for value in _numbers_of(getattr(record, name)):
            refuse_implausible(value, kind.unit, f"{where}.{key}", kind.above == 0.0 and not kind.tiny)
    return record


def refuse_implausible(value: float, unit: str, key: str, positive: bool = False) -> None:
    """`CaseError` where a value [SI] is larger than makes sense, or smaller though above 0; `unit` is that of its
    key."""
    least, most, what = PLAUSIBLE[SAME_AS.get(unit, unit)]
    if abs(value) <= most and not (positive and abs(value) < least):
        return
    given, low, high = (number / UNITS[unit] for number in (value, least, most))
    bounds = f"from {low:g} to {high:g}" if positive else f"at most {high:g} in size"
    sense = f"what makes sense here is {bounds} {unit.replace('_', ' ')}".rstrip()
    raise CaseError(f"{key} = {given:g}; {sense} ({what}): look at the unit and the exponent")


def _numbers_of(value: Any) -> list[float]:
    """The floats in a value, whether they stand alone or in lists."""
    if isinstance(value, tuple):
        return [number for part in value for number in _numbers_of(part)]
    return [value] if isinstance(value, float) else []


def _vector(kind: Kind, value: Any, key: str) -> tuple:
    if not isinstance(value, list):
        raise CaseError(f"{key} = {value!r}; it must be a list of numbers in {spelled(kind.unit)}")
    if kind.components and (len(value) != kind.components or any(isinstance(v, list) for v in value)):
        raise CaseError(f"{key} = {str(value)[:80]}; it must have {kind.components} components")
    return tuple(
        _vector(kind, v, key) if isinstance(v, list) else _number(v, key, kind) * UNITS[kind.unit] for v in value
    )


def _in_unit(value: Any, unit: float) -> Any:
    """A value in SI as it is written: the shortest number that reads back as the same value, to the last bit."""
    if isinstance(value, tuple):
        return [_in_unit(v, unit) for v in value]
    if dataclasses.is_dataclass(value):
        return write(value)
    if not isinstance(value, float) or unit == 1.0:
        return value
    near = value / unit
    candidates = float(f"{near:.15g}"), near, math.nextafter(near, math.inf), math.nextafter(near, -math.inf)
    return next((c for c in candidates if c * unit == value), near)
