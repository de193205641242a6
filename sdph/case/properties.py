"""Answers of CoolProp, kept from one command to the next: to import it takes 4 s, more than all that a case asks of it.

They are in a file of the cache, by CoolProp's version and what was asked; what cannot be read or written there is asked
anew. What CoolProp refuses is not kept.
"""

from __future__ import annotations

import contextlib
import functools
import importlib.metadata
import json
import os
from pathlib import Path

from sdph.engine.device import CACHE

ABSENT = "CoolProp is not installed"


class Missing(ValueError):
    """CoolProp is not there."""


class Library:
    """Functions of CoolProp by name, as `PropsSI`; `Missing` where it is not there, its own errors else."""

    def __init__(self, folder: Path):
        try:
            version = importlib.metadata.version("CoolProp")
        except importlib.metadata.PackageNotFoundError:
            raise Missing(ABSENT) from None
        self.file, self.known = folder / f"coolprop-{version}.json", {}
        with contextlib.suppress(OSError, ValueError, TypeError):
            self.known = dict(json.loads(self.file.read_text(encoding="utf-8")))

    def __getattr__(self, function: str):
        return functools.partial(self._answer, function)

    def _answer(self, function: str, *given):
        asked = json.dumps([function, *given])
        if asked not in self.known:
            self.known[asked] = getattr(_imported(), function)(*given)
            with contextlib.suppress(OSError):
                self._keep()
        return self.known[asked]

    def _keep(self) -> None:
        self.file.parent.mkdir(parents=True, exist_ok=True)
        draft = self.file.with_suffix(f".{os.getpid()}")
        draft.write_text(json.dumps(self.known), encoding="utf-8")
        os.replace(draft, self.file)


@functools.cache
def library() -> Library:
    """The one of this process."""
    return Library(CACHE / "fluids")


def _imported():
    try:
        import CoolProp.CoolProp as own
    except ImportError:
        raise Missing(ABSENT) from None
    return own
