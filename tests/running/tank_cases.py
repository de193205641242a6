"""A tank of liquid for tests of what is told of it."""

from sdph.case import read as cases


def tank_case(**sections):
    return cases.from_table({
        "dimensions": 2, "effects": ["gravity", "density_diffusion", "tank"],
        "run": {"end_time_s": 0.1, "output_interval_s": 0.1},
        "domain": {"size_m": [0.6, 0.3], "gravity_m_s2": [0.0, -9.81]}, "resolution": {"spacing_mm": 10.0},
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 15.0, "history_interval_s": 0.02},
        "pools": {"water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.6, 0.12]}}, **sections,
    })  # fmt: skip
