"""Faults planted one at a time in a copy of the tree; CONTRIBUTING.md says how."""

from __future__ import annotations

import argparse
import itertools
import tempfile
from pathlib import Path

from . import draw
from .fault import Fault
from .record import Record
from .rooms import ROOMS
from .trial import UNBUILT, Laboratory

ROOT = Path(__file__).parents[2]


def arguments() -> argparse.Namespace:
    own = argparse.ArgumentParser(prog="python -m tests.faults", description=__doc__)
    own.add_argument("--seed", type=int, default=1, help="of the draw")
    own.add_argument("--count", type=int, default=80, help="faults that are planted")
    own.add_argument("--only", action="append", choices=ROOMS, default=[], help="room; may be given several times")
    own.add_argument("--given", type=Path, help="faults of this TOML file in place of drawn ones")
    own.add_argument("--list", action="store_true", help="say which they are and plant none")
    own.add_argument("--resume", action="store_true", help="go on with the record, what is in it is not planted again")
    own.add_argument("--again", action="store_true", help="with --resume: plant what was not caught once more")
    own.add_argument("--record", type=Path, default=ROOT / "runs" / "faults.csv", help="CSV file of outcomes")
    own.add_argument("--limit", type=float, default=1800.0, help="seconds that the tests of one fault may take")
    return own.parse_args()


def run(faults, count: int, record: Record, limit: float, again: bool) -> None:
    """Plant faults until `count` of them compiled, those on record counted, and planted once more where nobody saw them
    and `again` is set."""
    with tempfile.TemporaryDirectory(prefix="sdph-faults-") as place:
        laboratory = Laboratory(ROOT, Path(place), limit)
        planted = 0
        for fault in faults:
            if planted == count:
                break
            if fault not in record or (again and not record.caught(fault)):
                record.add(fault, laboratory.trial(fault))
                print(f"{record.rows[fault.name]['outcome']:9} {fault}  {record.rows[fault.name]['test']}", flush=True)
            planted += record.rows[fault.name]["outcome"] != UNBUILT


def chosen(own: argparse.Namespace):
    """The faults that were asked for, in order."""
    if own.given:
        return [fault for fault in draw.given(ROOT, own.given) if not own.only or fault.room in own.only]
    return draw.drawn(ROOT, own.seed, own.only)


def show(faults: list[Fault]) -> None:
    for fault in faults:
        print(f"{fault.room:12} {fault}")


def main() -> None:
    own = arguments()
    if own.list:
        show(list(itertools.islice(chosen(own), own.count)))
        return
    record = Record(own.record, own.resume)
    run(chosen(own), own.count, record, own.limit, own.again)
    print(record.report())


main()
