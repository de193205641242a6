"""Gas that a case takes as laminar though it would be turbulent, where grains do not rule it."""

from __future__ import annotations

from sdph.case.turbulent import SECTION, fastest_inlet

TURBULENT = 3000.0  # Reynolds number of a channel by its width and mean speed, Pope 2000, section 7.1
SOONER = 0.01  # of that time; our choice: beds have 1e-5 to 2e-3, mouths of sprays and risers 0.03 to 1


def reynolds(case) -> float:
    """U L/nu [-] of the fastest inlet and the narrowest side of the domain; 0 without an inlet."""
    return fastest_inlet(case) * min(case.domain.size) * case.gas.density / case.gas.viscosity


def ruled(s) -> bool:
    """True where grains, by their drag, stop the gas `SOONER` than its largest eddies turn over, L/U: then it is
    another flow among them."""
    return s.gas_drag_time * fastest_inlet(s.case) < SOONER * min(s.case.domain.size)


def warnings(s) -> list[str]:
    """Note on a flow of scales `s` without a model of turbulence whose friction and mixing are those of a laminar one;
    none where grains rule the gas."""
    own, found = s.case.gas.turbulence, reynolds(s.case)
    if (own is not None and own.model != "laminar") or found <= TURBULENT or ruled(s):
        return []
    return [
        f"the gas flows at Re = {found:.3g} by the narrowest side of the domain, turbulent from {TURBULENT:g} on, and "
        f"is taken as laminar: friction on walls and mixing are too small; give [{SECTION}] (OpenFOAM's gas)"
    ]
