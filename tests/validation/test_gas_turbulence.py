"""Short forms of `sdph validate gas_turbulence`: the models of sdphGasFoam against those of pimpleFoam."""

import numpy as np
import pytest

from sdph.study import validate

pytestmark = pytest.mark.openfoam


def study(name):
    return validate.part("gas_turbulence", name)


@pytest.mark.parametrize("model", ["kEpsilon", "kOmegaSST", "WALE"])
def test_eddy_viscosity_of_a_frozen_flow_is_that_of_openfoam(tmp_path, model):
    apart = study("frozen").apart(model, tmp_path)
    print(model, apart)
    assert set(apart) == {"U", "nut"} | ({"k", study("frozen").MODELS[model]} if model != "WALE" else set())
    assert max(apart.values()) < 1e-10


@pytest.mark.parametrize("model", ["kEpsilon", "kOmegaSST"])
def test_channel_flows_as_that_of_openfoam(tmp_path, model):
    """Developing still, with 400 cells: the whole one takes minutes. Without its eddy viscosity it is 4 % off."""
    found = study("channel").profiles(model, tmp_path, steps=40, long=4.0)
    off = abs(study("channel")._furthest(found) - 1.0)
    print(f"{model}: velocity {off:.2%} off, Re_tau {found.reynolds:.0f}")
    assert off < 0.01


def test_means_of_eddies_are_those_of_openfoam(tmp_path):
    """The start of them, 40 steps on 3072 cells: too few for chance to part the two. Both hold the flow rate."""
    eddies = study("eddies")
    ours, theirs = eddies.both(tmp_path, (12, 16, 16), settled=0.04, until=0.08)
    off = study("stock").furthest(ours.mean, theirs.mean)
    share = ours.friction.mean() / theirs.friction.mean()
    stirred = study("stock").furthest(ours.rms[:, :3], theirs.rms[:, :3])
    print(f"velocity {off:.2%} off, friction {share:.4f} of pimpleFoam's, rms {stirred:.1%} off")
    assert ours.mean.shape == (8,) and ours.rms.shape == (8, 4) and ours.velocity.shape == (4, 8)
    assert off < 0.005 and abs(share - 1.0) < 0.005 and stirred < 0.1  # with upwinding 0.6 %, 0.4 %, 15 %


def test_means_of_eddies_are_about_planes_and_alike_at_both_walls():
    """Of a mean flow seen from the frame, with stresses that are even about the middle, the shear odd."""
    eddies = study("eddies")
    places = eddies.centres((4, 8, 4))
    up = places[:, 1] / eddies.HALF - 1.0
    mean = np.stack([15.0 * (1.0 - up**2) - eddies.FRAME, *np.zeros((2, len(up)))], axis=1)
    stress = np.stack([4.0 - up**2, up**2, 1.0 + 0.0 * up, up], axis=1)
    found = eddies.moments(places, [(mean, stress + eddies.product(mean))] * 2)
    low = 1.0 - found.height
    assert found.velocity == pytest.approx(np.tile(15.0 * (1.0 - low**2), (4, 1)), rel=1e-5)
    wanted = np.stack([np.sqrt(4.0 - low**2), low, np.ones(4), low], axis=1)
    assert found.rms == pytest.approx(wanted, rel=1e-5)


def test_start_of_eddies_keeps_its_volume(monkeypatch):
    """The curl of a potential: what goes in at a point goes out there."""
    eddies, point = study("eddies"), np.array([0.4, 0.7, 0.3])
    monkeypatch.setattr(eddies, "WAVES", 1.0)
    near = point + 1e-4 * np.array([*np.eye(3), *-np.eye(3)])
    slopes = [eddies.start(near) @ np.eye(3)[axis] for axis in range(3)]
    apart = [(slopes[axis][axis] - slopes[axis][3 + axis]) / 2e-4 for axis in range(3)]
    assert abs(sum(apart)) < 1e-3 * max(map(abs, apart))


def test_parts_of_the_study_run_in_folders_of_their_own(tmp_path, monkeypatch):
    frozen, channel, eddies, seen = study("frozen"), study("channel"), study("eddies"), []
    alike = eddies.Moments(np.full(2, 0.1), np.ones((4, 2)), np.full((4, 2, 4), 2.0))
    even = channel.Profiles(*np.ones((3, 2)), channel.REYNOLDS, 0.0)
    monkeypatch.setattr(frozen, "apart", lambda model, folder: seen.append(folder) or {"nut": 0.0})
    monkeypatch.setattr(channel, "profiles", lambda model, folder: seen.append(folder) or even)
    monkeypatch.setattr(eddies, "both", lambda folder: seen.append(folder) or (alike, alike))
    told = [*frozen.checks(tmp_path), *channel.checks(tmp_path), *eddies.checks(tmp_path)]
    assert len(seen) == len(set(seen)) == 6 and (tmp_path / "eddies.png").exists() and all(row["ok"] for row in told)
