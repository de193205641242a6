"""Kernels that only a device needs: counting sort, running sums, sums and extremes in a fixed order.

Threads of a kernel take rounds in turn, or runs of rows one behind the other, whose number is that of the threads.
"""

from __future__ import annotations

import math

from sdph.engine.gpu.toolkit import cuda, kernel


@kernel
def fill(array, value):
    """array (n,) = value."""
    for i in range(cuda.grid(1), len(array), cuda.gridsize(1)):
        array[i] = value


@kernel
def times(factor, array, out):
    """out (n,) = factor * array."""
    for i in range(cuda.grid(1), len(array), cuda.gridsize(1)):
        out[i] = factor * array[i]


@kernel
def positive(array, out):
    """out (n,): array where it is above 0, else 0."""
    for i in range(cuda.grid(1), len(array), cuda.gridsize(1)):
        out[i] = max(array[i], 0.0)


@kernel
def sum_parts(values, part):
    """part (T, K): sum of every T-th row of values (N, K), of each of T threads."""
    t = cuda.grid(1)
    for c in range(part.shape[1]):
        found = 0.0
        for i in range(t, len(values), len(part)):
            found += values[i, c]
        part[t, c] = found


@kernel
def cut_parts(values, unit, bits, part):
    """part (T, 3): sums of every T-th of values (N,), each cut into three whole numbers of `bits`, the first of which
    counts units."""
    t, first, second, third = cuda.grid(1), 0, 0, 0
    for i in range(t, len(values), len(part)):
        left = values[i] / unit
        whole = math.floor(left)
        first += int(whole)
        left = (left - whole) * 2.0**bits
        whole = math.floor(left)
        second += int(whole)
        rest = math.floor((left - whole) * 2.0**bits)
        third += int(rest)
    part[t, 0], part[t, 1], part[t, 2] = first, second, third


@kernel
def most_parts(values, part):
    """part (T, K): the largest of these rows."""
    t = cuda.grid(1)
    for c in range(part.shape[1]):
        found = -math.inf
        for i in range(t, len(values), len(part)):
            found = max(found, values[i, c])
        part[t, c] = found


@kernel
def find_ends(values, part):
    """part (T, 2): least value with its sign turned, and largest one, of every T-th of values (N,)."""
    t, low, high = cuda.grid(1), -math.inf, -math.inf
    for i in range(t, len(values), len(part)):
        low, high = max(low, -values[i]), max(high, values[i])
    part[t, 0], part[t, 1] = low, high


@kernel
def sum_runs(lengths, part):
    """part (T,): sum of the t-th of T runs of lengths (N,)."""
    t = cuda.grid(1)
    run = (len(lengths) + len(part) - 1) // len(part)
    found = 0
    for i in range(t * run, min((t + 1) * run, len(lengths))):
        found += lengths[i]
    part[t] = found


@kernel
def begin_few(lengths, begin):
    """begin (N + 1,): sum of the lengths (N,) before each, and of all; one thread."""
    found = 0
    for i in range(len(lengths)):
        begin[i] = found
        found += lengths[i]
    begin[len(lengths)] = found


@kernel
def begin_all(lengths, part, begin):
    """begin (N + 1,): the same; part (T + 1,): sum of the runs of `sum_runs` before each of T threads."""
    t, threads = cuda.grid(1), len(part) - 1
    run = (len(lengths) + threads - 1) // threads
    found, end = part[t], min((t + 1) * run, len(lengths))
    for i in range(t * run, end):
        begin[i] = found
        found += lengths[i]
    if t * run <= len(lengths) <= (t + 1) * run:
        begin[len(lengths)] = found


@kernel
def widest(taken, abreast, width):
    """width (G,): `abreast` times the most of as many of taken (N,), group by group."""
    for group in range(cuda.grid(1), len(width), cuda.gridsize(1)):
        most = 0
        for i in range(group * abreast, min((group + 1) * abreast, len(taken))):
            most = max(most, taken[i])
        width[group] = abreast * most


@kernel
def spread(begin, abreast, start):
    """start (N + 1,): begin (G + 1,) of each one's group and its place in it; behind all, the end of the last group."""
    last = len(start) - 1
    for i in range(cuda.grid(1), last + 1, cuda.gridsize(1)):
        start[i] = begin[i // abreast] + i % abreast if i < last else begin[len(begin) - 1]


@kernel
def choose(mask, begin, rows):
    """rows: those at which the mask (N,) is set; begin (N + 1,) as of `begin_all`."""
    for i in range(cuda.grid(1), len(mask), cuda.gridsize(1)):
        if mask[i]:
            rows[begin[i]] = i


@kernel
def count(number, many):
    """many (C,) of those in each cell; number (N,) of each one's cell."""
    for i in range(cuda.grid(1), len(number), cuda.gridsize(1)):
        cuda.atomic.add(many, number[i], 1)


@kernel
def scatter(number, free, rows):
    """rows (N,) cell by cell, in each of them as threads come; free (C + 1,): first place of each cell, afterwards
    the one past its last."""
    for i in range(cuda.grid(1), len(number), cuda.gridsize(1)):
        rows[cuda.atomic.add(free, number[i], 1)] = i


@kernel
def tidy(start, rows):
    """rows (N,) of each cell in their order before; start (C + 1,). A cell is a round, and holds few."""
    for cell in range(cuda.grid(1), len(start) - 1, cuda.gridsize(1)):
        for end in range(start[cell] + 1, start[cell + 1]):
            own, place = rows[end], end
            while place > start[cell] and rows[place - 1] > own:
                rows[place] = rows[place - 1]
                place -= 1
            rows[place] = own
