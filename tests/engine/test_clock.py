"""Landmarks in time: what differs by round-off is one moment, and a run that gets nowhere is stopped."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.engine import clock


def of(end, interval, rows=None, report_at=(), average_from=0.0):
    run = {"end_time": end, "output_interval": interval, "report_at": report_at, "average_from": average_from}
    return clock.Clock(SimpleNamespace(**run), rows)


def test_a_window_ends_where_means_begin():
    assert of(1.0, 0.5, average_from=0.3).next(0.0) == 0.3
    assert of(1.0, 0.5).next(0.0) == 0.5


@pytest.mark.parametrize(("count", "interval"), [(12, 0.05), (3, 0.1), (7, 0.01), (6, 0.1), (1000, 1e-3)])
def test_going_on_past_the_end_takes_no_window_of_round_off(count, interval):
    """12 x 0.05 is more than 0.6 by round-off; a run that ended at 0.6 goes on to the next landmark at once."""
    end = float(f"{count * interval:.6g}")
    reached, further = of(end, interval), of(end + 0.4 * interval, interval)
    assert reached.outputs[-1] == end and len(reached.outputs) == count
    assert reached.over(end) and not further.over(end)
    assert further.next(end) == further.end
    assert further.writes(end) and further.part(end, 1e9, "test") == further.end


@given(interval=st.floats(1e-4, 1e2), count=st.integers(1, 300), off=st.floats(-1e-12, 1e-12))
def test_a_landmark_within_round_off_of_now_is_now(interval, count, off):
    moments = of((count + 1) * interval, interval)
    now = count * interval * (1.0 + off)
    assert moments.next(now) > now + 0.5 * interval
    assert moments.writes(now) and moments.rows_at(now)


@given(
    end=st.floats(1e-3, 1e3),
    parts=st.floats(0.2, 50.0),
    rows=st.floats(0.5, 50.0),
    reports=st.lists(st.floats(1e-3, 1.2), max_size=4),
)
def test_no_two_landmarks_that_are_taken_are_nearer_than_the_shortest_window(end, parts, rows, reports):
    moments = of(end, end / parts, end / rows, [share * end for share in reports])
    time, taken = 0.0, []
    while not moments.over(time):
        assert moments.next(time) - time > moments.shortest
        time = moments.next(time)
        taken.append(time)
    assert taken[-1] == end
    assert all(np.abs(np.array(taken) - t).min() <= moments.shortest for t in moments.landmarks)


@pytest.mark.parametrize("longest", [1e-30, 0.9e-9, float("nan")])
def test_a_run_that_gets_nowhere_is_stopped_with_the_cause(longest):
    with pytest.raises(clock.Stalled, match="the largest window asks for .* raise that limit"):
        of(10.0, 1.0).part(0.0, longest, "the largest window")


def test_what_is_left_is_cut_into_equal_parts():
    assert of(1.0, 1.0).part(0.0, 0.3, "x") == 0.25
    assert clock.count_of_parts(1.0, 0.25 * (1.0 - 1e-12), 0.0, "x") == 4
    assert clock.count_of_parts(1.0, np.inf, 0.0, "x") == 1
