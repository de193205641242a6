"""The device: loops launched there, and arrays of particles made, sorted and added up there.

What a run computes does not depend on which thread comes first: rows of a cell are put in order after they were
scattered, and sums are made by as many threads on every card, each of which adds up in one order.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from sdph.engine import arrays
from sdph.engine.gpu import functions, operators, products, sorting
from sdph.engine.gpu.operators import Operable, operable
from sdph.engine.gpu.toolkit import SIMULATED, Launcher, cuda, lies_there, made, strict
from sdph.engine.gpu.translation import kernel_of, results
from sdph.engine.world import BITS
from sdph.laws.compiled import Loop

# blocks and threads of a loop, whose threads take rounds in turn; of a loop that returns values, and of the threads
# that then add up theirs. Few in the simulator, and no divisor of what there is.
LOOP = (3, 2) if SIMULATED else (2048, 128)
PARTS = (2, 3) if SIMULATED else (256, 128)
SUMS = (1, 2) if SIMULATED else (1, 256)
SMALL = 1024  # bytes of an array of the host that a loop may take along (densities by phase, sides of cells)


class Card:
    """Counts what it launches and moves: `launches`, `sent` and `brought` (number, bytes) from and to the
    host."""

    def __init__(self):
        strict()
        self.launches, self.sent, self.brought = 0, np.zeros(2), np.zeros(2)
        self._known = {}  # arrays that loops have taken along, by what is in them
        self._launcher, self._rooms = Launcher(), {}

    def begin(self) -> None:
        """Run loops here whose arrays lie here."""
        operators.HANDLED.update(functions.KNOWN)
        arrays.card, Loop.elsewhere = self, self.run

    def run(self, loop, arguments):
        """Run a loop and return what it does; of arrays that lie in memory the processor runs it."""
        if not any(map(_there, arguments)):
            return loop.here(*arguments)
        arguments, many = tuple(map(self._along, arguments)), results(loop)
        if not many:
            return self._launch(kernel_of(loop), LOOP, *arguments)
        part = self._room((math.prod(PARTS), many))
        self._launch(kernel_of(loop), PARTS, part, arguments)
        found = self._joined(part, loop.largest).tolist()
        return found[0] if many == 1 else tuple(found)

    def _launch(self, kernel, size: tuple[int, int], *arguments) -> None:
        self.launches += 1
        self._launcher(kernel, size, arguments)

    def _room(self, shape: tuple[int, int]):
        """Array of float64 for what threads find, until the next of that shape is asked for."""
        if shape not in self._rooms:
            self._rooms[shape] = self.empty(shape, np.float64)
        return self._rooms[shape]

    def told(self, steps: int) -> dict[str, float]:
        """Columns of a summary: means over the steps taken."""
        steps = steps or 1
        moved = {"from": float(self.brought[1]) / steps, "to": float(self.sent[1]) / steps}
        told = {f"bytes_{way}_device_per_step": many for way, many in moved.items()}
        return {"launches_per_step": self.launches / steps} | told

    def _joined(self, part, largest: bool) -> np.ndarray:
        """(K,) sums, or largest values, of parts (T, K) of threads."""
        fewer = self._room((math.prod(SUMS), part.shape[1]))
        self._launch(sorting.most_parts if largest else sorting.sum_parts, SUMS, part, fewer)
        values = self.bring(fewer)
        return values.max(axis=0) if largest else values.sum(axis=0)

    def _along(self, value):
        """An argument, with small arrays of the host sent along, those of a tuple too."""
        if isinstance(value, np.ndarray):
            return self._sent_once(value)
        if isinstance(value, tuple) and any(isinstance(part, np.ndarray) for part in value):
            parts = map(self._along, value)
            return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
        return value

    def _sent_once(self, array):
        if array.nbytes > SMALL:
            raise TypeError(f"an array of {array.shape} lies in memory, and the loop's others on the device")
        key = array.dtype.str, array.shape, array.tobytes()
        if key not in self._known:
            if len(self._known) > 4 * SMALL:
                self._known.clear()
            self._known[key] = self.send(array)
        return self._known[key]

    def send(self, array: np.ndarray):
        """A copy of an array there."""
        self.sent += 1, array.nbytes
        return operable(cuda.to_device(np.ascontiguousarray(array)))

    def bring(self, array) -> np.ndarray:
        """A copy of an array in memory."""
        self.brought += 1, array.nbytes
        return array.copy_to_host()

    def value(self, array, n: int):
        """The n-th value of an array."""
        return self.bring(array[n : n + 1])[0]

    def empty(self, shape, kind):
        """Array of a shape and a type (see sdph.engine.arrays, as for the rest)."""
        return made(Operable, shape, kind)

    def filled(self, shape, kind, value):
        array = self.empty(shape, kind)
        if array.size:
            self._launch(sorting.fill, LOOP, array.reshape(array.size), value)
        return array

    def copy(self, array):
        twin = self.empty(array.shape, array.dtype)
        if array.size:
            twin.copy_to_device(array)
        return twin

    def times(self, factor: float, array):
        out = self.empty(array.shape, array.dtype)
        if array.size:
            self._launch(sorting.times, LOOP, factor, array.reshape(array.size), out.reshape(array.size))
        return out

    def positive(self, array):
        out = self.empty(array.shape, array.dtype)
        self._launch(sorting.positive, LOOP, array, out)
        return out

    def total(self, values) -> np.ndarray:
        part = self._room((math.prod(PARTS), values.shape[1]))
        self._launch(sorting.sum_parts, PARTS, values, part)
        return self._joined(part, False)

    def exact(self, values) -> float:
        """Sum of values (N,) as if it had been made without round-off (Demmel & Nguyen 2015, IEEE Trans. Comput. 64,
        2060): of whole numbers, below 2^(3 BITS) of the largest each."""
        most = max(map(abs, self.ends(values))) if len(values) else 0.0
        if most == 0.0:
            return 0.0
        unit, part = 2.0 ** (math.frexp(most)[1] - BITS), self.empty((math.prod(PARTS), 3), np.int64)
        self._launch(sorting.cut_parts, PARTS, values, unit, BITS, part)
        high, middle, low = (sum(column) for column in zip(*self.bring(part).tolist()))
        return math.ldexp((high << 2 * BITS) + (middle << BITS) + low, -2 * BITS) * unit

    def ends(self, values) -> tuple[float, float]:
        part = self._room((math.prod(PARTS), 2))
        self._launch(sorting.find_ends, PARTS, values, part)
        low, high = self._joined(part, True).tolist()
        return -low, high

    def begins(self, lengths):
        begin = self.empty(len(lengths) + 1, np.int64)
        if len(lengths) <= math.prod(SUMS):
            self._launch(sorting.begin_few, (1, 1), lengths, begin)
            return begin
        size = PARTS if len(lengths) > math.prod(PARTS) else SUMS
        part = self.empty(math.prod(size), np.int64)
        self._launch(sorting.sum_runs, size, lengths, part)
        self._launch(sorting.begin_all, size, lengths, self.begins(part), begin)
        return begin

    def begins_abreast(self, taken, abreast: int):
        """Begin of each row of `taken` (N,) entries where `abreast` ones stand side by side, and the end: (N + 1,)."""
        width = self.empty(-(-len(taken) // abreast), np.int64)
        start = self.empty(len(taken) + 1, np.int64)
        self._launch(sorting.widest, LOOP, taken, abreast, width)
        self._launch(sorting.spread, LOOP, self.begins(width), abreast, start)
        return start

    def chosen(self, mask):
        begin = self.begins(mask)
        rows = self.empty(int(self.value(begin, len(mask))), np.int32)
        self._launch(sorting.choose, LOOP, mask, begin, rows)
        return rows

    def starts(self, number, total: int):
        many = self.filled(total, np.int64, 0)
        self._launch(sorting.count, LOOP, number, many)
        return self.begins(many)

    def order(self, number, total: int):
        start = self.starts(number, total)
        rows, free = self.empty(len(number), np.int64), self.copy(start)
        self._launch(sorting.scatter, LOOP, number, free, rows)
        self._launch(sorting.tidy, LOOP, start, rows)
        return rows

    def joined(self, one, other):
        whole = self.empty(len(one) + len(other), one.dtype)
        if len(one):
            whole[: len(one)].copy_to_device(one)
        if len(other):
            whole[len(one) :].copy_to_device(other if lies_there(other) else self.send(other))
        return whole

    def dots(self, a, others: tuple, sums, places: tuple) -> None:
        """Sums of a b for each b of others, at their places among sums; nothing comes to the host."""
        part, fewer = (self._room((math.prod(size), len(others))) for size in (PARTS, SUMS))
        self._launch(products.multiply, PARTS, a, others, part)
        self._launch(sorting.sum_parts, SUMS, part, fewer)
        self._launch(products.put, (1, 1), fewer, sums, places)

    def fill(self, array, value) -> None:
        if array.size:
            self._launch(sorting.fill, LOOP, array.reshape(array.size), value)

    def counted(self, count: int):
        out = self.empty(count, np.int64)
        if count:
            self._launch(operators.count_up, LOOP, out)
        return out

    def stacked(self, columns):
        return operators.stacked(columns)

    def columns(self, table):
        return operators.columns(table)

    def launch(self, kernel, *arguments) -> None:
        """Run a kernel over all values."""
        self._launch(kernel, LOOP, *map(self._along, arguments))


def _there(value) -> bool:
    """True where an argument, or a part of a tuple, lies on the device."""
    return lies_there(value) or (isinstance(value, tuple) and any(map(lies_there, value)))


@functools.cache
def begun() -> Card:
    """The device of this process, begun."""
    card = Card()
    card.begin()
    return card
