"""A spray of nobody's: two nozzles in a plane box, one in a cross flow and one of many sizes."""

from sdph.case import read as cases

EFFECTS = ["inflow", "outflow", "gravity", "drag", "heat", "evaporation"]


def table() -> dict:
    return {
        "title": "nobody's", "dimensions": 2, "effects": EFFECTS,
        "run": {"end_time_s": 0.02, "output_interval_s": 0.01},
        "domain": {"size_m": [0.8, 0.4], "gravity_m_s2": [0.0, -9.81]},
        "resolution": {"spacing_mm": 25.0, "cell_mm": 50.0},
        "gas": {
            "equation_of_state": "operating", "density_kg_m3": 0.946, "viscosity_Pa_s": 2.2e-5,
            "conductivity_W_m_K": 0.032, "heat_capacity_J_kg_K": 1011.0, "temperature_K": 373.0,
        },
        "grains": {
            "density_kg_m3": 998.0, "diameter_mm": 0.1, "heat_capacity_J_kg_K": 4182.0, "conductivity_W_m_K": 0.6,
        },
        "vapour": {
            "molar_mass_kg_kmol": 18.015, "diffusivity_m2_s": 3.7e-5, "heat_capacity_J_kg_K": 1900.0,
            "conductivity_W_m_K": 0.024, "viscosity_Pa_s": 1.2e-5,
        },
        "nozzles": {
            "left": {
                "shape": "slot", "width_m": 0.1, "temperature_K": 300.0, "centre_m": [0.0, 0.2],
                "direction": [1.0, 0.0], "speed_m_s": 8.0, "volume_fraction": 1e-3,
            },
            "top": {
                "shape": "cone", "temperature_K": 300.0, "radius_m": 0.05, "half_angle_deg": 10.0,
                "centre_m": [0.3, 0.4], "direction": [0.0, -1.0], "speed_m_s": 10.0, "rate_kg_s": 0.5,
                "diameter_std_mm": 0.03, "start_s": 0.005, "end_s": 0.015,
            },
        },
        "boundaries": {
            "wind": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [2.0, 0.0], "temperature_K": 373.0},
            "out": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 10.0, "temperature_K": 360.0},
            "walls": {"kind": "slip_wall"},
        },
        "drag": {"law": "putnam"}, "heat": {"law": "ranz_marshall"},
        "evaporation": {"latent_heat_J_kg": 2.257e6, "saturation": "antoine", "antoine": [9.6543, 1435.264, -64.848]},
    }  # fmt: skip


def case(**changes):
    """The case with sections that have other entries, or are others where they are no tables; less those of effects
    that are off."""
    own = table()
    for name, change in changes.items():
        own[name] = own.get(name, {}) | change if isinstance(change, dict) else change
    off = {"drag", "heat", "evaporation", *(["nozzles"] if "inflow" not in own["effects"] else [])} - set(
        own["effects"]
    )
    return cases.from_table({name: entry for name, entry in own.items() if name not in off})
