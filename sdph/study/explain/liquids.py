"""`sdph explain` of a case with a liquid: its numbers, its effects, what limits its step and what it will cost."""

from __future__ import annotations

import contextlib
import math

import numpy as np

from sdph import effects
from sdph.case import fluids
from sdph.effects.around import drain, tank
from sdph.engine import state as particles
from sdph.engine.state import LIQUID
from sdph.laws.constants import SAME
from sdph.methods.liquids import bodies, filling
from sdph.methods.liquids.bounds import limits as limits_of_step
from sdph.methods.liquids.liquid import SLOW
from sdph.schema import CaseError
from sdph.study.explain import edges, estimate, feed, prices, ruling, tanks

WATER = 0.0728  # N/m, of water in air at 20 C (IAPWS R1-76): for the Weber and Bond numbers of a case that gives none
# of a step: neighbours and forces made anew where a drain has taken particles; measured, 9943 in a cylinder on its side
REMOVING = 2.3
KEYS_OF_PIPE = "give tank.outlet_radius_m and outlet_length_m"
PIPES = {  # shape of a tank, in two dimensions or three -> how it gets an outlet pipe; others: PIPE
    ("mesh", 3): "give tank.mesh a pipe at its lowest point, closed at the end, unless it has one",
    ("outline", 2): "draw a pipe into tank.corners_m: a notch down from the floor, closed at the end",
    ("sphere", 2): 'a disc has none: give tank.shape = "outline" and draw disc and pipe by tank.corners_m',
    ("box", 2): KEYS_OF_PIPE,
}
OUTLET = "tank.outlet_radius_m"
OUTLETS = {"mesh": "the pipe in tank.mesh", "outline": "the notch in tank.corners_m"}  # of pipes drawn in the tank
PIPE = f"{KEYS_OF_PIPE}, or a tank.mesh with a pipe at its lowest point, closed at the end"
DAMPED = "what damps waves is the program's artificial viscosity, and not the liquid's"


def explain(s, shared=None) -> dict[str, list]:
    """Numbers that decide, ratios, limits of the step, and what to expect: rows of a table each. `shared` are the steps
    that it has with another matter (`lockstep.Shared`), if any."""
    steps = limits(s)
    return {"numbers": numbers(s), "ratios": ratios(s), "limits": steps, "expected": expected(s, steps, shared)}


def numbers(s) -> list[tuple]:
    """(name, value, threshold, what lies above it, source)."""
    own, (across, _) = s.liquid, s.pull
    froude = s.speed / math.sqrt((across + s.shaken) * s.length) if across + s.shaken else math.inf
    sigma, where = _tension(s.case)
    weber, bond = s.capillary(sigma)
    cell = s.speed * s.case.smoothing_length / s.viscosity if s.viscosity else math.inf
    reynolds = s.speed * s.length / s.viscosity if s.viscosity else math.inf
    mach, crossings = s.speed / own.sound_speed, own.sound_speed * s.end / s.length
    slow = "the liquid is compressed by more than 4 %; usual is 0.1"
    rows = [
        ("Reynolds, U L/nu", reynolds, 2000.0, "the flow may become turbulent", "Reynolds 1883"),
        ("Reynolds of the particles, U h/nu", cell, 1.0, "viscosity does not damp single particles", "Monaghan 1992"),
        ("Froude, U/sqrt(g L)", froude, 1.0, "inertia beats gravity", "by its definition"),
        ("Mach, U/c", mach, SLOW, slow, "Monaghan 1994"),
        ("Weber, rho U2 L/sigma", weber, 1.0, "inertia beats surface tension", where),
        ("Bond, rho g L2/sigma", bond, 1.0, "gravity beats surface tension", where),
        ("run / (L/U)", s.turns, 1.0, "the flow has time to turn over", "by its definition"),
        ("boundary layer, sqrt(nu t)/L", s.layer, 0.01, "walls slow the liquid", "Schlichting 1979, ch. 5"),
        ("crossings of sound, c t/L", crossings, 1.0, "noise has time to go to and fro", "Marrone et al. 2011"),
    ]
    damping = s.case.parameters.get("liquid_damping")
    if "liquid_damping" in s.case.effects and damping.model == "linear":
        viscosity = damping.alpha * s.case.smoothing_length * own.sound_speed / (2.0 * (s.case.dimensions + 2.0))
        ratio = viscosity * own.density / own.viscosity if own.viscosity else math.inf
        rows.append(("viscosity of damping / the liquid's", ratio, 1.0, DAMPED, "Monaghan 2005, Rep. Prog. Phys. 68"))
    if s.case.gas_phase:
        ratio = own.density / s.case.gas_phase.density
        rows.append(("density ratio", ratio, 1.0, "the gas yields to the liquid", "by its definition"))
    return rows


def _tension(case) -> tuple[float, str]:
    """Surface tension [N/m] of a case, of its bubble where it has no other, or that of water, and where it is from."""
    own, bubble = (case.parameters.get(name) for name in ("surface_tension", "bubble"))
    if own and hasattr(own, "coefficient"):
        return own.coefficient, "by its definition"
    if bubble and bubble.surface_tension:
        return bubble.surface_tension, "by its definition; bubble.surface_tension_N_m"
    if case.liquid.fluid and case.liquid.fluid_temperature:
        with contextlib.suppress(CaseError):  # no library, or no surface at that temperature
            named = fluids.Fluid(case.liquid.fluid, "liquid")
            return named.at("I", T=case.liquid.fluid_temperature, Q=0.0), f"by its definition; of {case.liquid.fluid}"
    return WATER, "by its definition; surface tension of water, for want of one"


def ratios(s) -> list[dict]:
    """Kernel, spacing and liquid against each other, with the range that is safe and why."""
    h, spacing = s.case.smoothing_length, s.case.resolution.spacing
    rows = [
        ("h / spacing", h / spacing, 1.2, 2.0, "fewer neighbours make noise, more blur"),
        ("liquid's width / h", s.length / h, 6.0, math.inf, "less than three kernels across is all rim"),
    ]
    return [
        {"ratio": n, "value": v, "least": low, "most": high, "safe": "yes" if low <= v <= high else "NO", "why": w}
        for n, v, low, high, w in rows
    ]


def pulled(s) -> float:
    """Speed [m/s] that tension gives to a drop as wide as the narrowest of the liquid: sqrt(sigma/(rho a))."""
    if "surface_tension" not in s.case.effects:
        return 0.0
    return math.sqrt(2.0 * s.case.parameters["surface_tension"].coefficient / (s.liquid.density * s.length))


def warnings(s) -> list[str]:
    """Ratios that are not safe, and sound that is too slow."""
    unsafe = [*edges.unsafe(ratios(s)), *_too_fast(s), *ruling.warnings(s.case, s.end, limits(s))]
    layer, around = s.layer * s.length, s.case.parameters.get("tank")
    if around and around.shape == "box" and around.outlet_radius and s.pull[0] + s.shaken and _pipe_empty(s):
        unsafe.append(
            "the outlet pipe begins empty: liquid falls into it at the start, drain or no drain; give a pool "
            'shape = "tank", which fills the pipe too'
        )
    if "frame" in s.case.effects and around and around.slip == "no_slip" and 0.0 < layer < s.case.resolution.spacing:
        unsafe.append(
            f"the layer that a wall drags along, sqrt(nu t) = {1e3 * layer:.3g} mm, is thinner than the spacing: "
            "friction at walls, and how soon the liquid turns with its tank, are then the numerics', tens of times too "
            "much; tank.slip = 'free_slip' has no friction at walls"
        )
    unsafe += _of_drain(s) if "drain" in s.case.effects else []
    return unsafe + tanks.warnings(s.case)


def _of_drain(s) -> list[str]:
    """Lines where a drain takes its liquid faster than its pipe brings it, or without one."""
    told, c, around = [], s.liquid.sound_speed, s.case.parameters["tank"]
    drawn = 0.0 if around.outlet_radius else _pipe_drawn(s.case, around)
    through, falls = drain.speed(s.case, drawn), _falls(s)
    wider = f"let drain.end_s be later, or the outlet wider ({OUTLETS.get(around.shape) if drawn else OUTLET})"
    if through > SLOW * c:
        told.append(
            f"the drain takes its liquid through the outlet at {through:.3g} m/s, {through / c:.2g} of the speed of "
            f"sound: it is torn out rather than drained; {wider}"
        )
    if through > falls > 0.0:
        told.append(
            f"the drain takes its liquid through the outlet at {through:.3g} m/s; by its weight it leaves at "
            f"{falls:.3g} m/s at most in the end (Torricelli). It is pulled out by command, the pipe runs dry, and "
            f"pressures at the outlet are not those of a drain; {wider}"
        )
    if not (drawn or around.outlet_radius):
        told.append(
            "a tank without an outlet pipe gives up its lowest particles, wherever on its floor they are: pressures "
            f"and loads meanwhile are not those of a drain; {PIPES.get((around.shape, s.case.dimensions), PIPE)}"
        )
    return told


def _too_fast(s) -> list[str]:
    """A line where the liquid is faster than its sound was chosen for, and what faster sound costs."""
    c, fastest = s.liquid.sound_speed, max(s.speed, pulled(s))
    if fastest <= SLOW * c:
        return []
    fast = f"the liquid may reach {fastest:.3g} m/s, {fastest / c:.2g} of its speed of sound"
    wanted = f"raise liquid.sound_speed_m_s from {c:g} to {10.0 * fastest:.3g}"
    return [f"{fast}: {wanted}, which lets a step be {step_of_sound(s.case, fastest):.2g} s long"]


def step_of_sound(case, speed: float) -> float:
    """Longest step [s] of a liquid with a speed [m/s] and sound ten times as fast."""
    return case.liquid.courant * case.smoothing_length / (11.0 * speed)


def _pipe_drawn(case, around) -> float:
    """Width or area [m^(d-1)] of the pipe of an outline or a mesh, where it is level at its lowest, over less than half
    of its mean width or area (our choice); 0 where it has none."""
    if around.shape == "mesh":
        return _pipe_of_mesh(case)
    if around.shape != "outline":
        return 0.0
    corners = np.array(around.corners)
    lowest = corners[corners[:, 1] <= corners[:, 1].min() + SAME * case.resolution.spacing]
    width = float(np.ptp(lowest[:, 0]))
    return width if width < 0.5 * tank.shape_of(case).volume / np.ptp(corners[:, 1]) else 0.0


def _pipe_of_mesh(case) -> float:
    """The same of a mesh; a facet of a round floor, smaller than a particle, is none."""
    shape, up = tank.shape_of(case), filling.upwards(case)
    facets = np.asarray(shape.triangles.points, float)[shape.triangles.regular_faces]
    heights, spacing = facets @ up, case.resolution.spacing
    level = facets[heights.max(axis=1) <= heights.min() + SAME * spacing]
    area = 0.5 * np.linalg.norm(np.cross(level[:, 1] - level[:, 0], level[:, 2] - level[:, 0]), axis=1).sum()
    return float(area) if spacing**2 <= area < 0.5 * shape.volume / np.ptp(heights) else 0.0


def _over_floor(s):
    """Heights (W,) [m] of the liquid over the floor of a box tank; below 0 in its outlet pipe."""
    up = (s.state.x, s.state.y, s.state.z)[s.case.dimensions - 1][s.state.kind == LIQUID]
    return up - tank.corners(s.case)[0][-1]


def _pipe_empty(s) -> bool:
    """True where there is liquid, and all of it above the floor."""
    up = _over_floor(s)
    return len(up) > 0 and up.min() > 0.0


def _falls(s) -> float:
    """Speed [m/s] at which liquid leaves the outlet pipe of a box by its weight when the drain ends, sqrt(2 g z), z the
    depth left and the pipe; 0 where a frame moves, whose forces are others, and where nozzles fill the tank before."""
    case, around = s.case, s.case.parameters["tank"]
    if "frame" in case.effects or "gravity" not in case.effects or case.nozzles or around.shape != "box":
        return 0.0
    up = _over_floor(s)
    if not len(up):
        return 0.0
    left = (up.max() + 0.5 * case.resolution.spacing) * case.parameters["drain"].fill / drain.filled(case)
    return math.sqrt(2.0 * math.hypot(*case.domain.gravity) * (left + around.outlet_length))


def limits(s) -> list[dict]:
    """Largest step [s] by cause, before run.step_factor."""
    parameters = {name: effects.kernel_of(effects.REGISTRY[name], s.case) for name in s.case.effects}
    found = effects.finite(limits_of_step(s.case, parameters, s.state, s.speed, sum(s.pull) + s.shaken))
    least = min(found.values())
    return [{"cause": k, "largest [s]": v, "rules": "<-" if v == least else ""} for k, v in found.items()]


def _beside(s, shared) -> tuple[int, int]:
    """Numbers of liquid particles, both phases, and of all that a run has at the start, those of its bodies among
    them."""
    if shared is None:
        return int(particles.wet(s.state).sum()), len(s.state.x)
    left = bodies.beside(s.case, s.state, shared.places)
    return int(particles.wet(left).sum()), len(left.x) + len(shared.places)


def _drained(case) -> float:
    """Area or volume [m^d] that the drain takes."""
    if "drain" not in case.effects:
        return 0.0
    return max(0.0, drain.filled(case) - case.parameters["drain"].fill) * tank.shape_of(case).volume


def expected(s, steps: list[dict], shared=None) -> list[dict]:
    """Particles, steps, memory, wall time; bodies that stand in the liquid take its place."""
    wet, start = _beside(s, shared)
    spacing = s.case.resolution.spacing
    came = sum(feed.mouth(s.case, n) * feed.way(s.case, n) for n in s.case.nozzles.values())
    count = start + (0 if "outflow" in s.case.effects and wet else round(came / spacing**s.case.dimensions))
    end, longest = shared[:2] if shared else (s.end, min(row["largest [s]"] for row in steps))
    number = estimate.steps(s.case, end, longest)
    paid = number + REMOVING * min(number, _drained(s.case) / spacing**s.case.dimensions)
    wall = 1e-6 * prices.of_liquid(s.case) * 0.5 * (start + count) * paid
    return [
        {"what": "liquid particles", "value": wet + count - start, "unit": ""},
        {"what": "particles, walls included", "value": count, "unit": ""},
        {"what": "steps", "value": number, "unit": ""},
        {"what": "memory", "value": estimate.memory(s.case, count, 0) / 1e6, "unit": "MB"},
        {"what": "wall time", "value": wall, "unit": f"s (measured on {prices.speed().measured})"},
    ]
