"""PySPH's side of against_pysph.py, under the Python that Debian's python3-pysph belongs to.

    python3 pysph_side.py PARTICLES.npz

Says `ready`, then for each number read from stdin evaluates the equations so many times (neighbours included) and
prints the seconds that took. Equations: delta-SPH of WCSPHScheme without XSPH, as sdph has them.
"""

import sys
import time

import numpy as np
from compyle.config import get_config
from pysph.base.kernels import CubicSpline
from pysph.base.utils import get_particle_array_wcsph
from pysph.sph.basic_equations import XSPHCorrection
from pysph.sph.scheme import WCSPHScheme
from pysph.tools.sph_evaluator import SPHEvaluator


def evaluator(given):
    get_config().use_openmp = True
    d, h, spacing = int(given["dimensions"]), float(given["h"]), float(given["spacing"])
    arrays = []
    for name, chosen in (("fluid", given["wet"]), ("solid", ~given["wet"])):
        columns = {key: given[key][chosen] for key in ("x", "y", "z", "u", "v", "w", "m", "rho")}
        arrays.append(get_particle_array_wcsph(name=name, h=h * np.ones(chosen.sum()), **columns))
    scheme = WCSPHScheme(
        ["fluid"], ["solid"], dim=d, rho0=float(given["rho_0"]), c0=float(given["c_0"]), h0=h, hdx=h / spacing,
        gy=-9.81, alpha=0.02, beta=0.0, delta=0.1, delta_sph=True,
    )  # fmt: skip
    scheme.setup_properties(arrays)
    groups = scheme.get_equations()
    for group in groups:
        group.equations = [equation for equation in group.equations if not isinstance(equation, XSPHCorrection)]
    return SPHEvaluator(arrays, groups, d, CubicSpline(dim=d))


def main():
    own = evaluator(np.load(sys.argv[1]))
    own.update()
    own.evaluate()
    print("ready", flush=True)
    for line in sys.stdin:
        begun = time.perf_counter()
        for _ in range(int(line)):
            own.update()
            own.evaluate()
        print(time.perf_counter() - begun, flush=True)


if __name__ == "__main__":
    main()
