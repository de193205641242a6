"""Gas that takes the temperature of its grains at once, and bursts out of them, is told of before and after."""

import re

import pytest
from builders import FULL_BOX, disc, simulation
from fakes import StillGas

from coupling.gas import GasError, Unfinished
from sdph.case import judge
from sdph.methods.grains import expansion
from sdph.study.explain import tables

VARIES = 'gas.equation_of_state="operating"'
BOTH = r"gas\.temperature_K \(350\) and particles\.disc\.temperature_K \({:g}\)"


def told(*overrides):
    return expansion.warnings(case := disc(*overrides), judge.scales_of(case))


@pytest.mark.parametrize(("kelvin", "does"), [(700.0, "expands 2 times (its density 0.5 times)"),
                                              (280.0, "shrinks 1.25 times (its density 1.25 times)")])  # fmt: skip
def test_both_keys_ratio_of_densities_and_time_are_told(kelvin, does):
    case = disc(VARIES, f"particles.disc.temperature_K={kelvin}")
    (line,) = told(VARIES, f"particles.disc.temperature_K={kelvin}")
    assert re.match(BOTH.format(kelvin), line) and does in line
    scales = judge.scales_of(case)
    speed = abs(1.0 - kelvin / 350.0) / max(1.0, kelvin / 350.0) * scales.length / scales.gas_heat_time
    assert f"in {scales.gas_heat_time:.2g} s" in line and f"at up to {speed:.3g} m/s" in line
    assert line in tables.warnings(case)


@pytest.mark.parametrize("more", [
    (), (VARIES, "particles.disc.temperature_K=350"), (VARIES, "particles.disc.temperature_K=351"),
    (VARIES, "coupling.one_way=true"),
], ids=["constant density", "alike", "nearly alike", "one way"])  # fmt: skip
def test_others_are_not_told_of(more):
    assert not told(*more)


class Failing(StillGas):
    """A gas that finishes nothing."""

    def advance(self, dt, sources):
        super().advance(dt, sources)
        raise Unfinished("the gas fails")


@pytest.mark.parametrize(("more", "names"), [((VARIES,), True), ((), False)])
def test_the_failure_names_both_keys(tmp_path, more, names):
    run = simulation(disc(*FULL_BOX, *more), tmp_path, gas=Failing)
    with pytest.raises(GasError, match="the gas fails") as caught:
        run.window()
    assert bool(re.search("begin with " + BOTH.format(288) + " alike", str(caught.value))) is names


def test_a_later_failure_has_other_causes():
    case = disc(VARIES)
    scales = judge.scales_of(case)
    assert [bool(expansion.told_by(case, scales, share * scales.gas_heat_time)) for share in (0.9, 1.1)] == [
        True,
        False,
    ]
