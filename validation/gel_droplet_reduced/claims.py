"""Claims of Qiang et al. 2017, as far as a droplet of one bubble without particles can judge them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.laws import cavities, real_gas
from sdph.study.compare import check

from . import runs

# issue 20's specification: tear at a flaw of 7 % between 1.35 and 1.47 D_0, at 0.75 s, 150 kPa; then 68 kPa in 100 ms
RATIO, TIME, PRESSURE, AFTER = (1.41, 0.06), (0.75, 0.05), (150e3, 0.05), (68e3, 0.05)
SOON = 0.1  # s, in which it is to fall there


def checks(folder: Path, overrides=(), reporter=None) -> list[dict]:
    """Tear, pressures, and the pressure at which the jet stops being sonic."""
    found = runs.course()
    own, h, v = found.summary, found.history, found.model.vapour
    ambient = found.model.around.ambient
    sonic = ambient / cavities.critical_ratio(v.heat_ratio) - ambient
    fallen = np.flatnonzero(h["pressure_Pa"][found.tear :] < AFTER[0])
    fall = h["time_s"][found.tear + fallen[0]] - h["time_s"][found.tear] if len(fallen) else np.nan
    return [
        check("D/D_0 of the tear at a flaw of 7 %", own["rupture_diameter_ratio"], *RATIO),
        check("time of the tear [s]", own["rupture_time_s"], *TIME, True),
        check("largest pressure [Pa]", own["pressure_max_Pa"], *PRESSURE, True),
        check("gauge pressure at which the jet stops being sonic [Pa]", sonic, *AFTER, True),
        check("time from the tear to 68 kPa [s]", fall, 0.0, SOON),
        check("two bubbles that merge: heat made, of what they hold", _merger(v), 0.0, 1e-10),
    ]


def _merger(v) -> float:
    """Heat made by a merger of bubbles at 1 and 1.5 bar, over the heat they hold [-]."""
    temperatures = tuple(real_gas.saturation_temperature(v, p) for p in (1e5, 1.5e5))
    voids = tuple(cavities.void(r, 2) for r in (1.5e-4, 1.1e-4))
    masses = tuple(real_gas.saturated_density(v, T) * A for T, A in zip(temperatures, voids))
    common, boiled = cavities.merged(v, masses, voids, temperatures)
    held = v.heat_capacity * sum(m * T for m, T in zip(masses, temperatures))
    after = v.heat_capacity * sum(masses) * common + v.latent_heat * boiled
    return after / held - 1.0
