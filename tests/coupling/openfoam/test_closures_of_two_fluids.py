"""What `libtwoFluidClosures` adds to twoPhaseEulerFoam and takes out of it (fvOptions): its grains then have the theory
of ours."""

import shutil

import numpy as np
import pytest
from test_comparators import AIR, SAND, _own_shelf, bed, last  # noqa: F401 (a fixture)

from coupling.openfoam.comparators import run as comparators
from sdph import scenes
from sdph.case import read as cases
from sdph.laws import granular

pytestmark = pytest.mark.openfoam

THETA, STEEPNESS, STEP = 0.2, 1.0, 1e-9  # m2/s2, m/s2, s


def agitated(folder, monkeypatch, alpha_p):
    """A case of grains at rest that fill `alpha_p`, agitated by THETA + STEEPNESS y between open sides, two steps of
    STEP long."""
    made = shutil.copytree(comparators.template(cases.load(scenes.find("granular_jet")[1]), "tfm"), folder)
    monkeypatch.setattr(comparators, "template", lambda case, kind: made)
    sides = {"floor": -STEEPNESS, "lid": STEEPNESS}
    for file in (made / "0").iterdir():
        text = file.read_text()
        for side, slope in sides.items():
            kind = {
                "Theta.particles": f"type fixedGradient; gradient uniform {slope};",
                "p": "type calculated; value $internalField;",
                "p_rgh": "type prghPressure; p $internalField; value $internalField;",
            }.get(file.name, "type zeroGradient;")
            text = text.replace("boundaryField\n{", f"boundaryField\n{{\n{side} {{ {kind} }}")
        file.write_text(text)
    rows = " ".join(repr(THETA + STEEPNESS * 0.01 * (j + 0.5)) for j in range(10) for _ in range(4))
    for name, old, new in (
        ("0/Theta.particles", "uniform $grains_granular_temperature", f"nonuniform List<scalar> 40({rows})"),
        ("0/alpha.particles", "internalField   uniform 0", f"internalField   uniform {alpha_p}"),
        ("system/controlDict", "$time_step", repr(STEP)),
    ):
        text = (made / name).read_text()
        assert text.count(old) == 1
        (made / name).write_text(text.replace(old, new))
    head = (made / "system/setFieldsDict").read_text().split("#include")[0]
    (made / "system/setFieldsDict").write_text(head + "defaultFieldValues ();\nregions ();\n")
    open_side = {"kind": "pressure_outlet", "pressure_Pa": 0.0, "temperature_K": 288.0}
    return cases.from_table({
        "title": "agitated", "scene": "granular_jet", "dimensions": 2, "effects": ["drag", "granular_pressure", "heat"],
        "run": {"end_time_s": 2.0 * STEP, "output_interval_s": STEP},
        "domain": {"size_m": [0.04, 0.1], "gravity_m_s2": [0.0, 0.0]},
        "resolution": {"spacing_mm": 5.0, "cell_mm": 10.0},
        "gas": AIR, "grains": SAND | {"diameter_mm": 3.0, "granular_temperature_m2_s2": THETA},
        "particles": {"stream": {
            "shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.04, 0.1], "volume_fraction": alpha_p,
            "temperature_K": 288.0,
        }},
        "boundaries": {
            "floor": open_side | {"side": "bottom"}, "lid": open_side | {"side": "top"}, "walls": {"kind": "slip_wall"},
        },
    })  # fmt: skip


@pytest.mark.parametrize("alpha_p, decays", [(0.2, 1e-7), (0.625, 3e-5)])
def test_a_gradient_of_agitation_pushes_grains_by_that_of_their_pressure(tmp_path, monkeypatch, alpha_p, decays):
    """rho alpha du/dt = -(dp_s/dtheta) grad(theta) at even alpha_p: `agitationGradient` of the closures library. From
    the second step on: the solver has no g0 in the first. At 0.625 of 0.63 g0 is held at its value for 0.62, half of
    its own, as ours is: `cappedSinclairJackson`, which the onset of friction does not ask. Theta
    `decays` by so much meanwhile."""
    case = agitated(tmp_path / "template", monkeypatch, alpha_p)
    run = comparators.run_two_fluid(case, tmp_path / "run")
    first, second = (run.fields[t]["particle_velocity"] for t in sorted(t for t in run.fields if t > 0.0))
    e, g0 = case.grains.restitution, granular.crowding(alpha_p, case.grains.packing_limit)
    slope = granular.lun_pressure(alpha_p, 1.0, e, g0, 3060.0)
    pushed = alpha_p * 3060.0 * (second - first) / STEP
    assert len(pushed) == 40
    np.testing.assert_allclose(pushed[:, 1], -slope * STEEPNESS, rtol=10.0 * decays)
    assert np.abs(pushed[:, 0]).max() < 10.0 * decays * slope * STEEPNESS


def test_slip_alone_gives_two_fluids_no_agitation(tmp_path):
    """The theory of sdph has no source of theta by slip, which the solver has: `noSlipSource` takes it out. What slips
    evenly then only calms down."""
    case = bed(0.3, jet=1.0, distributor=1.0, end=2e-3)
    run = comparators.run_two_fluid(case, tmp_path / "run")
    inside = (np.abs(run.centres[:, 0] - 0.1) < 0.06) & (np.abs(run.centres[:, 1] - 0.1) < 0.04)
    theta = last(run)["granular_temperature"][inside] / case.grains.granular_temperature
    slip = np.abs(last(run)["gas_velocity"] - last(run)["particle_velocity"])[inside, 1]
    print(f"theta over that of the start {theta.min():.3g} to {theta.max():.3g}, slip at least {slip.min():.2g} m/s")
    assert slip.min() > 0.5 and 0.0 < theta.max() < 1.0


def test_viscosity_of_grains_conducts_no_heat_in_two_fluids(tmp_path, monkeypatch):
    """Hot grains on cold ones, so agitated that nu is some 1e-4 m2/s: the solver takes it for a conductivity of eddies,
    which `noEddyHeat` takes out. What is left, k/(rho c) = 7e-7 m2/s, is little."""
    own = cases.to_table(bed(0.3, jet=0.01, distributor=0.01, end=1e-2, outputs=20))
    own["domain"]["gravity_m_s2"] = [0.0, 0.0]  # or what falls is warm
    own["effects"].remove("gravity")
    own["grains"] |= {"diameter_mm": 3.0, "granular_temperature_m2_s2": 0.01, "conductivity_W_m_K": 5.0}
    made = shutil.copytree(comparators.template(cases.from_table(own), "tfm"), tmp_path / "template")
    hot = "boxToCell { box (-1 0.1 -1) (1 1 1); fieldValues (volScalarFieldValue T.particles 350); }"
    fields = made / "system" / "setFieldsDict"
    fields.write_text(fields.read_text().replace("regions\n(", f"regions\n({hot}"))
    monkeypatch.setattr(comparators, "template", lambda case, kind: made)
    run = comparators.run_two_fluid(cases.from_table(own), tmp_path / "run")
    beside = np.isclose(run.centres[:, 1], 0.095) & (np.abs(run.centres[:, 0] - 0.1) < 0.08)
    warmed = last(run)["particle_temperature"][beside] - 288.0
    print(f"warmed by {warmed.min():.3g} to {warmed.max():.3g} K")
    assert np.abs(warmed).max() < 0.05
