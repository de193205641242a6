"""Converged value of a ladder by its own refinement, and the doubt about it.

The step h of a level is the value of the ladder's first knob; all knobs are refined together, so that the error goes
as h^p. Through the finest three levels, where they change one way and less and less:

    p in (h1^p - h2^p)/(h2^p - h3^p) = (f1 - f2)/(f2 - f3),  limit = f3 + delta,  delta = (f3 - f2)/((h2/h3)^p - 1)

(Richardson 1911; Roache 1994, J. Fluids Eng. 116, 405). p above 2 counts as 2, the order of the schemes here: it is
luck or noise, and 2 leaves the larger delta (Eca & Hoekstra 2014, J. Comput. Phys. 262, 104). The doubt about the
limit is |delta|, so that the finest is told to err by 2 |delta|: Roache's safety factor is 1.25 where four grids
agree upon p and 3 for two grids; 2 for three levels, whose noise goes into p, is our choice (Xing & Stern 2010, J.
Fluids Eng. 132, 061403 have 1.6 to 2.0 there for p between the full and half the expected order).

That is done only where all changes between the finest four (three, of a ladder of three) have one sign and shrink.
Three values that lie by chance do so in 14 ladders of 100, four in 1: a metric of a curve that fluctuates is thus not
sold by two rungs that happen to be close.

Where the finest three turn, there is no order to go by: the finest, in doubt by the range of the three (between half
the range of Stern et al. 2001, J. Fluids Eng. 123, 793 and the 1.5 ranges of Eca & Hoekstra). Where these go one way,
but with p below 1/2, or only from the fourth one on, or are only two: the finest, in doubt by Roache's
3 |f3 - f2|/(h2/h3 - 1), first order and his factor for two grids, or by their range, if that is more. One level says
nothing.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

LEAST_ORDER, FULL_ORDER = 0.5, 2.0  # Eca & Hoekstra 2014: orders between them (they: 2.1) are believed
TWO_GRIDS = 3.0  # Roache 1994: safety factor where the order is not observed
NAMED = {2: "two", 3: "three", 4: "four"}


class Limit(NamedTuple):
    """Converged value, the doubt about it in the same unit, the order that it rests on (nan: none) and why there is
    none; `swings` of values that go up and down, or change more and more, as those of a fluctuating curve do."""

    value: float
    doubt: float
    order: float
    why: str = ""
    swings: bool = False


def limit(steps: list[float], values: list[float]) -> Limit:
    """The limit of `values` at `steps` (both from coarse to fine, no step twice) as the step goes to 0."""
    if len(values) < 2 or not all(map(math.isfinite, values)):
        return Limit(values[-1], math.inf, math.nan, "fewer than two rungs have a number")
    if max(values[-3:]) == min(values[-3:]):
        return Limit(values[-1], 0.0, math.nan, "the finest rungs are alike")
    if why := disorder(steps, values):
        return _ranged(steps[-3:], values[-3:], why)._replace(swings=len(values) > 2)
    steps, values = steps[-3:], values[-3:]
    p = believed(steps, (values[0] - values[1]) / (values[1] - values[2]))
    if math.isnan(p):
        return _ranged(steps, values, "changes of the finest three rungs hardly shrink")
    more = (values[-1] - values[-2]) / ((steps[-2] / steps[-1]) ** p - 1.0)
    return Limit(values[-1] + more, abs(more), p)


def disorder(steps: list[float], values: list[float]) -> str:
    """Reason why no order can be fitted to values, coarse to fine; empty where the changes between the finest four have
    one sign and shrink, as those of an order above 0 do."""
    if len(values) == 2:
        return "two rungs have no order"
    for count in (3, 4)[: len(values) - 2]:
        told = f"the finest {NAMED[count]} rungs"
        first, second, *_ = (fine - coarse for coarse, fine in itertools.pairwise(values[-count:]))
        coarse, middle, fine, *_ = steps[-count:]
        if first * second <= 0.0:
            return f"{told} go up and down"
        if abs(first) * math.log(middle / fine) <= abs(second) * math.log(coarse / middle):
            return f"changes of {told} do not shrink"
    return ""


def _ranged(steps: list[float], values: list[float], why: str) -> Limit:
    """The finest of two or three values as their limit, in doubt as above where no order is observed."""
    change, spread = values[-1] - values[-2], max(values) - min(values)
    one_way = len(values) == 2 or change * (values[1] - values[0]) > 0.0
    rough = TWO_GRIDS * abs(change) / (steps[-2] / steps[-1] - 1.0) if one_way else 0.0
    own = "three times the last change, by first order", f"the spread of the finest {NAMED[len(values)]}"
    return Limit(values[-1], max(spread, rough), math.nan, f"{why}; doubt: {own[rough <= spread]}")


def believed(steps: list[float], ratio: float) -> float:
    """Observed order of three steps whose changes are in `ratio`, at most 2; nan below 1/2."""
    if ratio >= power_ratio(*steps, FULL_ORDER):
        return FULL_ORDER
    return order(*steps, ratio, 1.0, (LEAST_ORDER, FULL_ORDER))


def order(coarse: float, middle: float, fine: float, first: float, second: float, within=(-10.0, 10.0)) -> float:
    """p of changes `first` and `second` between three steps, (coarse^p - middle^p)/(middle^p - fine^p) = first/second;
    by bisection in `within`, nan where no power there fits."""
    low, high = within

    def excess(p: float) -> float:
        return power_ratio(coarse, middle, fine, p) - first / second

    if excess(low) * excess(high) > 0.0:
        return math.nan
    for _ in range(60):
        p = 0.5 * (low + high) or 1e-9  # at 0 both changes vanish
        low, high = (p, high) if excess(p) * excess(high) <= 0.0 else (low, p)
    return 0.5 * (low + high)


def power_ratio(coarse: float, middle: float, fine: float, p: float) -> float:
    """(coarse^p - middle^p)/(middle^p - fine^p), which grows with p."""
    return (coarse**p - middle**p) / (middle**p - fine**p)
