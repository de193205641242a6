"""Keys and sections that nothing would act on in a case are refused, in a line that says why."""

import copy
import dataclasses

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.schema import CaseError
from sdph.study.explained import warned

WATER = {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [1.0, 0.5]}
TANK = {
    "dimensions": 2, "effects": ["gravity", "density_diffusion", "tank"],
    "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
    "domain": {"size_m": [1.0, 1.0], "gravity_m_s2": [0.0, -9.81]}, "resolution": {"spacing_mm": 50.0},
    "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 50.0}, "tank": {"open_sides": ["top"]},
    "pools": {"water": WATER},
}  # fmt: skip
DRAIN = {"fill": 0.1, "end_s": 0.5}
HEAT = {"conductivity_W_m_K": 0.6, "heat_capacity_J_kg_K": 4200.0, "temperature_K": 300.0}
HEATED = {"effects": ["density_diffusion", "liquid_heat"], "tank": None, "liquid_heat": HEAT}
TWO = {name: {"shape": "disc", "centre_m": [x, 0.5], "radius_m": 0.2} for name, x in (("a", 0.25), ("b", 0.75))}
DRAINED = {"effects": ["gravity", "tank", "drain"], "drain": DRAIN}
RING = {"shape": "ring", "centre_m": [0.5, 0.5], "radius_m": 0.3, "inner_radius_m": 0.2}
BODY = {"shape": "box", "lower_m": [0.2, 0.2], "upper_m": [0.8, 0.4]}
SOLID = {
    "effects": [], "tank": None, "pools": None, "liquid": None,
    "domain": {"size_m": [1.0, 1.0], "gravity_m_s2": [0.0, 0.0]},
    "solid": {"density_kg_m3": 1000.0, "youngs_modulus_Pa": 1e6, "poisson_ratio": 0.3},
}  # fmt: skip


def plate(**solid):
    """A plate of this solid."""
    return SOLID | {"solid": SOLID["solid"] | solid, "bodies": {"plate": BODY}}


CASES = {
    "tank.open_sides": {"tank": {"shape": "sphere", "centre_m": [0.5, 0.5], "radius_m": 0.5, "open_sides": ["top"]}},
    "shifting.phases": {"effects": ["density_diffusion", "shifting"], "tank": None, "shifting": {"phases": "gas"}},
    "domain.gravity_m_s2": {
        "effects": ["gravity", "tank", "drain"], "drain": DRAIN,
        "domain": {"size_m": [1.0, 1.0], "gravity_m_s2": [9.81, 0.0]},
    },
    "liquid_heat.temperature_K": HEATED | {"liquid_heat": {k: v for k, v in HEAT.items() if k != "temperature_K"}},
    "liquid_heat.flux_W_m2 = 5": HEATED | {"liquid_heat": HEAT | {"flux_W_m2": 5.0}},
    "liquid_heat.flux_W_m2 = 6": HEATED | {"liquid_heat": HEAT | {"flux_W_m2": 6.0}, "pools": TWO},
    "the case has the effect drain": HEATED | {
        "effects": ["gravity", "tank", "drain", "liquid_heat"], "drain": DRAIN, "tank": {"open_sides": ["top"]},
    },
    "the case has liquid.periodic": HEATED | {
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 50.0, "periodic": [1, 0]},
    },
    "bodies.plate: no particle lies between held_lower_m": SOLID | {
        "bodies": {"plate": {
            "shape": "box", "lower_m": [0.2, 0.2], "upper_m": [0.8, 0.4], "held_lower_m": [0.0, 0.0],
            "held_upper_m": [0.21, 1.0],
        }},
    },
    "frame.table": {
        "effects": ["tank", "frame"], "frame": {"table": "moves.csv", "shake": [[0, 0.1, 6.0, 0.0]]},
    },
    "bodies.one and bodies.two overlap, 20 pairs": SOLID | {
        "bodies": {
            "one": {"shape": "box", "lower_m": [0.2, 0.2], "upper_m": [0.5, 0.4]},
            "two": {"shape": "box", "lower_m": [0.25, 0.2], "upper_m": [0.6, 0.4]},
        },
    },
    "frame turns the domain across an axis that is periodic": {
        "effects": ["frame"], "tank": None, "frame": {"spin_rad_s": [0.0, 0.0, 1.0]},
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 50.0, "periodic": [1, 0]},
    },
    "pools.water.speed_m_s = 2 is that of a flow": {"pools": {"water": WATER | {"speed_m_s": 2.0}}},
    "pools.water.fill = 0.5 is that of the tank": {"pools": {"water": WATER | {"fill": 0.5}}},
    'no pool has phase = "gas"': {"gas_phase": {"density_kg_m3": 1.2, "sound_speed_m_s": 100.0}},
    "pools.a and pools.b overlap": DRAINED | {
        "pools": {name: TWO[name] | {"radius_m": 0.3} for name in "ab"},
    },
    "pools.water and pools.a do not tell how full the tank is": DRAINED | {
        "pools": {"water": {"shape": "tank", "fill": 0.2}, "a": TWO["a"]},
    },
    "bubbles are in a case of one pool; pools hold ring, far": {
        "effects": ["bubble"], "tank": None, "bubble": {"centre_m": [0.5, 0.5]},
        "pools": {"ring": RING, "far": WATER | {"lower_m": [0.0, 0.0], "upper_m": [0.1, 0.1]}},
    },
    'method.name = "mps" moves a liquid alone': {
        "effects": ["gravity", "tank"], "method": {"name": "mps"},
        "solid": {"density_kg_m3": 1000.0, "youngs_modulus_Pa": 1e6, "poisson_ratio": 0.3},
        "bodies": {"flap": {"shape": "box", "lower_m": [0.4, 0.5], "upper_m": [0.6, 0.8]}},
    },
    "no periodic axes beside nozzles or outflow": {
        "effects": ["outflow"], "tank": None, "method": {"name": "mps"},
        "liquid": {"density_kg_m3": 1000.0, "periodic": [1, 0]},
    },
    "outflow takes a liquid of one phase out, and there is [gas_phase]": {
        "effects": ["gravity", "density_diffusion", "tank", "outflow"],
        "gas_phase": {"density_kg_m3": 1.2, "sound_speed_m_s": 100.0},
        "pools": {"water": WATER, "air": WATER | {"lower_m": [0.0, 0.5], "upper_m": [1.0, 1.0], "phase": "gas"}},
    },
    "effects holds bubble and outflow": {
        "effects": ["bubble", "outflow"], "tank": None, "bubble": {"centre_m": [0.5, 0.5]}, "pools": {"ring": RING},
    },
    "tank.shape = 'sphere' is closed, and liquid.periodic = [1.0, 0.0] goes on beyond it": {
        "tank": {"shape": "sphere", "centre_m": [0.5, 0.5], "radius_m": 0.5},
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 50.0, "periodic": [1, 0]},
        "pools": {"water": {"shape": "tank", "fill": 0.5}},
    },
    "pools.ring.shape = 'ring' is of two dimensions": {
        "dimensions": 3, "domain": {"size_m": 3 * [1.0], "gravity_m_s2": [0.0, 0.0, -9.81]},
        "pools": {"ring": RING | {"centre_m": 3 * [0.5]}},
    },
    "tank.outlet_centre_m = [(0.5,)]": {
        "tank": {"outlet_radius_m": 0.1, "outlet_length_m": 0.1, "outlet_centre_m": [[0.5]]},
    },
    "[solid] gives hardening_Pa, which acts on nothing without yield_stress_Pa": plate(hardening_Pa=1e5),
    "[solid] gives softening_exponent, which acts on nothing": plate(softening_exponent=2.0),
    "bodies.plate.radius_m is of no box": plate() | {"bodies": {"plate": BODY | {"radius_m": 0.1}}},
    "bodies.ring.flaw_at_deg = 90, and there is no flaw": SOLID | {"bodies": {"ring": RING | {"flaw_at_deg": 90.0}}},
    "method.reach is of moving particles": {"method": {"reach": 3.1}},
    "[solid] gives critical_damage, which acts on nothing without failure": plate(
        critical_damage=0.5, yield_stress_Pa=1e5
    ),
    "inflation.pressure_Pa = 0 loads nothing": SOLID | {
        "effects": ["inflation"], "bodies": {"ring": RING}, "inflation": {"body": "ring"},
    },
    'bubble.flux_W_m2 is of a bubble of vapour, and bubble.content = "gas"': {
        "effects": ["bubble"], "tank": None, "bubble": {"centre_m": [0.5, 0.5], "flux_W_m2": 1e4},
        "pools": {"ring": RING},
    },
    "bodies.plate.speed_m_s = 2 is of motion": plate() | {"bodies": {"plate": BODY | {"speed_m_s": 2.0}}},
    "inflation.growth_1_s": SOLID | {
        "effects": ["inflation"], "bodies": {"ring": RING},
        "inflation": {"body": "ring", "growth_1_s": 1.0, "bulk_modulus_Pa": 1e9},
    },
}  # fmt: skip


def test_the_embedded_gas_begins_at_the_origin(tmp_path):
    """Its cells would stand beside the grains."""
    case = cases.load(scenes.find("disc_cluster")[1], ('coupling.gas="embedded"',))
    moved = dataclasses.replace(case, domain=dataclasses.replace(case.domain, lower=(-0.1, 0.0)))
    with pytest.raises(CaseError, match=r"domain.lower_m = \[-0.1, 0.0\], but the embedded gas begins at the origin"):
        warned(moved, tmp_path)


@pytest.mark.parametrize("told", CASES)
def test_what_would_do_nothing_is_refused(told, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "moves.csv").write_text("time_s,ax_m_s2,ay_m_s2,az_m_s2,wx_rad_s,wy_rad_s,wz_rad_s\n0,0,0,0,0,0,0\n")
    table = copy.deepcopy({key: value for key, value in (TANK | CASES[told]).items() if value is not None})
    with pytest.raises(CaseError) as refused:
        warned(cases.from_table(table), tmp_path, whole=True)
    assert told in str(refused.value) and "\n" not in str(refused.value)


def test_a_run_by_moving_particles_tells_what_it_does_without():
    """Keys of an equation of state and of a kernel, in a case that was written for the other method."""
    table = copy.deepcopy(TANK) | {"method": {"name": "mps"}}
    table["liquid"]["exponent"] = 1.0
    case = cases.from_table(table)
    assert case.method.left_out == ("density_diffusion", "liquid.sound_speed_m_s", "liquid.exponent")
