"""Reduced model of a gel droplet: base case, tear, account, hard cases, and its command."""

import json

import numpy as np
import pytest

from sdph import cli
from sdph.schema import CaseError
from sdph.study.gel_droplet import sections
from sdph.study.gel_droplet.course import Course
from sdph.study.gel_droplet.model import Model


def course(*overrides):
    return Course(sections.load(None, overrides))


@pytest.fixture(scope="module")
def base():
    return course()


def test_it_grows_tears_and_vents(base):
    own, h = base.summary, base.history
    assert base.model.torn == "the spot failed"
    assert 1.35 < own["rupture_diameter_ratio"] < 1.47
    assert own["rupture_time_s"] == pytest.approx(0.75, rel=0.05)
    assert np.all(np.diff(h["time_s"]) > 0.0)
    assert h["pressure_Pa"][-1] < 0.1 * h["pressure_Pa"][base.tear]
    assert h["vented_kg"][base.tear] == 0.0 < own["vented_kg"]


def test_mass_and_heat_close_to_round_off_and_work_by_the_step(base):
    own, finer = base.summary, course("numerics.growth_step=2.5e-4", "numerics.longest_step_ms=0.5").summary
    assert own["mass_drift_rel"] < 1e-12
    assert own["heat_drift_rel"] < 1e-10
    assert abs(finer["work_drift_rel"]) < 0.6 * abs(own["work_drift_rel"]) < 1e-3


def test_settings_are_converged(base):
    """Half the step, twice the rings and layers change the tear by less than 0.1 %."""
    for change in ("growth_step=2.5e-4", "longest_step_ms=0.5", "rings=120", "layers=8"):
        own = course(f"numerics.{change}").summary
        for key in ("rupture_time_s", "rupture_diameter_ratio", "pressure_max_Pa"):
            assert own[key] == pytest.approx(base.summary[key], rel=1e-3), change


HARD = {
    "small bubble": ("droplet.bubble_diameter_mm=0.1",),
    "flaw 30 %": ("shell.flaw=0.3",),
    "soft": ("shell.youngs_modulus_Pa=5e6",),
    "stiff": ("shell.youngs_modulus_Pa=1e8",),
    "ten times the flux": ("heating.flux_W_m2=1.42e6",),
    "no rate": ("shell.rate_factor=0",),
    "paper's gas": ("vapour.equation_of_state=redlich_kwong_paper",),
    "sphere": ("droplet.dimensions=3", "droplet.shell_thickness_um=33.6"),
    "1 MPa": ("droplet.ambient_pressure_Pa=1e6",),
}


@pytest.mark.parametrize("name", HARD)
def test_hard_cases_tear_and_close(name):
    own = course(*HARD[name]).summary
    assert own["torn"] in ("the spot failed", "the spot ran away")
    assert own["mass_drift_rel"] < 1e-12
    assert own["heat_drift_rel"] < 1e-10
    assert abs(own["work_drift_rel"]) < 0.01


def test_without_a_flaw_nothing_tears_below_3():
    assert course("shell.flaw=0").summary["rupture_diameter_ratio"] > 3.0


def test_one_that_is_hardly_warmed_does_not_tear():
    found = course("heating.flux_W_m2=1e3", "numerics.end_time_s=0.1")
    assert found.tear is None
    assert found.summary["torn"] == "not torn"
    assert found.history["time_s"][-1] == pytest.approx(0.1, rel=1e-12)


def test_a_step_that_is_too_long_changes_nothing(base):
    model = Model(sections.load(None, ()))
    for _ in range(3):
        assert model.step(1e-3)
    before = model.row()
    assert not model.step(10.0)
    assert model.row() == before


def test_command(tmp_path, capsys):
    file = tmp_path / "drop.toml"
    file.write_text("[shell]\nflaw = 0.3\n")
    assert cli.main(["droplet", str(file), "--set", "vent.time_ms=0.1", "--out", str(tmp_path / "out"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told == json.loads((tmp_path / "out" / "summary.json").read_text())
    table = np.genfromtxt(tmp_path / "out" / "droplet.csv", delimiter=",", names=True)
    assert table["time_s"][-1] == pytest.approx(told["rupture_time_s"] + 1e-4, rel=1e-9)
    assert (tmp_path / "out" / "droplet.png").is_file()


def test_pressures_are_told_to_be_gauge(tmp_path, capsys):
    """At the start the droplet has the pressure around; the line says what to add."""
    short = (
        "--set",
        "droplet.ambient_pressure_Pa=2e5",
        "--set",
        "numerics.end_time_s=1e-3",
        "--out",
        str(tmp_path / "out"),
    )
    assert cli.main(["droplet", *short]) == 0
    assert (
        "pressures are gauge, of the gel over that around: add ambient_pressure_Pa = 200000 " in capsys.readouterr().out
    )
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["ambient_pressure_Pa"] == 2e5
    assert np.genfromtxt(tmp_path / "out" / "droplet.csv", delimiter=",", names=True)["pressure_Pa"][0] < 1e5


@pytest.mark.parametrize(
    ("override", "told"),
    [
        ("droplet.ambient_pressure_Pa=10", "if bar was meant, give 1e+06"),
        ("shell.youngs_modulus_Pa=9.9", "if MPa was meant, give 9.9e+06"),
        ("vapour.molar_mass_kg_kmol=46.07", "two fuels in one"),
        ("droplet.ambient_pressure_Pa=101325", ""),
    ],
)
def test_slips_of_a_unit_are_said(override, told):
    said = []
    own = sections.load(None, (override,))
    assert sections.judged(own, said.append) == own
    assert len(said) == bool(told) and all(line.startswith("warning: ") for line in said)
    assert all(told in line for line in said)


def test_the_command_says_them(tmp_path, capsys):
    given = ("droplet.ambient_pressure_Pa=10", "numerics.end_time_s=1e-3")
    words = [word for one in given for word in ("--set", one)]
    assert cli.main(["droplet", *words, "--out", str(tmp_path / "out")]) == 0
    assert "warning: droplet.ambient_pressure_Pa = 10 is far from usual" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("override", "told"),
    [
        ("shell.flaw=1", "at most 0.99"),
        ("shel.flaw=0.1", "did you mean shell?"),
        ("droplet.dimensions=4", "2 (a cylinder) or 3"),
        ("droplet.bubble_diameter_mm=0.95", "inside the shell there are 0.9 mm"),
        ("droplet.ambient_pressure_Pa=1e7", "above it nothing boils"),
        ("droplet.ambient_pressure_Pa=1.7e6", "K before the shell tears, and the fuel's critical temperature is 658.1"),
        ("droplet.shell_thickness_um=600", "give a smaller bubble or a thinner shell"),
    ],
)
def test_bad_input_is_refused_in_one_line(override, told, capsys):
    assert cli.main(["droplet", "--set", override]) == 2
    error = capsys.readouterr().err
    assert told in error
    assert error.count("\n") == 1


def test_gel_that_boils_dry_is_told():
    with pytest.raises(CaseError, match="boils dry"):
        course("droplet.bubble_diameter_mm=0.89")
