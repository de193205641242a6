"""Times of a run and of its reference of OpenFOAM: those that both have, and one line where there is none."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from coupling.openfoam.comparators import run as comparators
from sdph.schema import CaseError
from sdph.study import compare, droplets, two_fluid
from tests.coupling.openfoam import spray_cases
from tests.study import test_two_fluid as beds


def finished(case, end: float, folder=None):
    """A run that ends at `end` [s], whose fields nobody may read but the first."""
    first = SimpleNamespace(gas=SimpleNamespace(GetClassName=lambda: "vtkRectilinearGrid"), particles=None)
    first.particles = SimpleNamespace(n_points=1)
    return SimpleNamespace(case=case, summary={"time_s": end}, folder=folder, fields=lambda t: first)


def with_fields(folder, times):
    """A run with fields at some times."""
    rows = "".join(f'<DataSet timestep="{t:.9g}" part="0" file="fields/particles_00000.vtp"/>' for t in times)
    (folder / "run.pvd").write_text(f"<VTKFile><Collection>{rows}</Collection></VTKFile>", encoding="utf-8")
    return finished(beds.case(run={"end_time_s": 0.7, "output_interval_s": 0.05}), max(times), folder)


def test_times_that_one_side_lacks_are_left_out(tmp_path):
    """A run to 0.6 s every 0.1 s, gone on with every 0.05 s, which OpenFOAM had from the start."""
    run = with_fields(tmp_path, [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.65, 0.7])
    reference = SimpleNamespace(fields={round(0.05 * k, 8): {} for k in range(14, 0, -1)})
    assert compare.times_of_both(run, reference) == [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.65, 0.7]
    thirds = SimpleNamespace(fields={0.33333333: {}, 0.66666667: {}, 0.7001: {}})  # in the digits of OpenFOAM
    assert compare.times_of_both(with_fields(tmp_path, [0.0, 1 / 3, 2 / 3, 0.7]), thirds) == [0.33333333, 0.66666667]


def test_no_time_alike_is_one_line(tmp_path):
    run = with_fields(tmp_path, [0.0, 0.04, 0.08])
    with pytest.raises(CaseError, match="at none of the times of its reference, every 0.05 s") as refused:
        compare.times_of_both(run, SimpleNamespace(fields={0.05: {}, 0.1: {}}))
    assert "\n" not in str(refused.value)


def test_a_run_that_is_too_short_has_no_checks_and_no_reference_is_run(monkeypatch):
    """`sdph compare` says then how to go on."""
    for module, name in ((two_fluid, "run_two_fluid"), (droplets, "run_droplets")):
        monkeypatch.setattr(module, name, lambda *given, **more: pytest.fail("a reference is run"))
    assert two_fluid.tfm(finished(beds.case(), 0.5e-3)) == []
    assert droplets.dpm(finished(spray_cases.case(), 5e-3)) == []


def test_a_case_without_an_output_is_refused_before_openfoam_runs(tmp_path):
    """As that of a scene, whose comparison is its own."""
    short = {"end_time_s": 0.5e-3, "output_interval_s": 1e-3}
    for run, own in ((comparators.run_two_fluid, beds.case), (comparators.run_droplets, spray_cases.case)):
        with pytest.raises(CaseError, match=r"run.end_time_s = 0.0005 lies before the first output"):
            run(own(run=short), tmp_path / "short")
    assert not (tmp_path / "short").exists()


def of_outputs(monkeypatch, times, interval=0.5, end=None):
    """A run of liquid with fields and metrics at some times, or until `end` [s]."""
    case = SimpleNamespace(run=SimpleNamespace(output_interval=interval))
    own = SimpleNamespace(time_values=list(times))
    monkeypatch.setattr(compare.timeline, "read", lambda folder: own)
    monkeypatch.setattr(compare.timeline, "state_at", lambda own, time: ("fields", time))
    table = {"time_s": np.array(times), "front_m": 10.0 * np.array(times)}
    monkeypatch.setattr(compare.Finished, "metrics", property(lambda run: table))
    return compare.Finished(Path("run"), case, {"time_s": max(times) if end is None else end}, {})


def test_no_output_stands_in_for_one_at_another_time(monkeypatch):
    """Where a run has fields every 0.5 s, none at 0.3 s is made of that of 0.5 s, by whatever way it is asked for."""
    run = of_outputs(monkeypatch, [0.0, 0.5, 1.0])
    assert run.fields(0.5) == ("fields", 0.5) and run.metric("front_m", 1.0) == 10.0 and run.outputs([0.5]) == [0.5]
    assert run.fields(0.5 + 2e-8) and run.metric("front_m", 0.5 - 2e-8) == 5.0  # digits of files
    line = "run has no output at 0.3 s, where it is compared; the nearest is at 0.5 s: run it anew with "
    for asked in (run.fields, lambda t: run.metric("front_m", t), lambda t: run.outputs([0.5, t])):
        with pytest.raises(CaseError, match=f"^{line}run.output_interval_s ") as refused:
            asked(0.3)
        assert "\n" not in str(refused.value)


def test_times_that_a_run_does_not_reach_are_told(monkeypatch):
    run = of_outputs(monkeypatch, [0.0, 0.5, 1.0], end=0.9999999999)
    assert run.reached([0.5, 1.0]) == run.outputs([0.5, 1.0]) == [0.5, 1.0]  # an end in the digits of a clock
    assert run.notices == []
    assert run.outputs([0.5, 2.0, 10.0]) == [0.5]
    assert run.notices == ["run ends at 1 s: no check at 2, 10 s"]
