"""Particles of a liquid and of its walls at the start of a case."""

from __future__ import annotations

import math

import numpy as np

from sdph import effects
from sdph.effects.around import frame, tank
from sdph.effects.around.source import Source
from sdph.effects.liquids import bubble
from sdph.engine import lattice
from sdph.engine import state as particles
from sdph.engine.state import GAS, LIQUID, WALL
from sdph.engine.walls import layers
from sdph.engine.world import ALONE, here
from sdph.laws import eos
from sdph.laws.liquids import quadrupole, taylor_green, wave
from sdph.methods.liquids import filling, pressures
from sdph.schema import CaseError

INVERSIONS = 50  # of the inversion of Van der Waals' equation; each takes off nine tenths of the error or more


def fill(case, world=ALONE) -> particles.State:
    """All liquid and wall particles of a case, numbered from 0, liquid first; each process of a world makes a part of
    them."""
    if not case.pools and "inflow" not in case.effects:
        raise CaseError("no liquid: give it in a section such as [pools.column], or let it in by [nozzles.NAME]")
    pools = filling.pools(case)
    parts = [_pool(case, pools, number, world) for number in range(len(pools))]
    if "tank" in case.effects:
        parts.append(_walls(case, world))
    state, first = placed(case, np.zeros((0, case.dimensions))), 0
    for part in parts:
        part.ident[:] = np.arange(len(part.ident)) + first + world.before(len(part.ident))
        state, first = particles.join(state, part), first + world.sum(len(part.ident))
    if case.pools and not world.any((state.kind == LIQUID).any()):
        raise CaseError("pools hold no particle of liquid; enlarge one, or give a finer resolution.spacing_mm")
    return state


def world_of(case):
    """Processes that each make a part of the particles at the start: of nozzles, bodies, bubbles and walls with forces
    of their own each has to know all."""
    of_all = case.run.forces or case.solid or {"inflow", "bubble"} & {*case.effects}
    return ALONE if of_all else here()


def _walls(case, world) -> particles.State:
    shape, spacing = tank.shape_of(case), case.resolution.spacing
    parts = layers.wall_points(shape, spacing, tank.layers(case))
    points, volume = np.concatenate(parts), layers.volumes(shape, parts, spacing)
    if "inflow" in case.effects:
        walled = Source(case, (), 0).mouths(placed(case, points)) == 0
        points, volume = points[walled], volume[walled]
    own = slice(*world.ends(len(points)))
    points, volume = points[own], volume[own]
    state = placed(case, points)
    if len(state.depth):
        state.depth[:] = shape.distance(points)
    state.kind[:] = WALL
    state.density[:] = case.liquid.density
    state.mass[:] = case.liquid.density * volume
    return state


def pipe_walls(case) -> int:
    """Number of wall particles of an outlet pipe; they come last."""
    own = case.parameters.get("tank")
    if not (own and own.outlet_radius):
        return 0
    return len(layers.wall_points(tank.shape_of(case), case.resolution.spacing, tank.layers(case))[1])


def placed(case, points) -> particles.State:
    """Particles at points (N, d) [m], with what the effects of a case need, all 0."""
    state = particles.empty(len(points), effects.arrays(case), case.dimensions)
    for axis, column in zip(particles.axes(state), points.T):
        axis[:] = column
    return state


def _places(case, pool, world) -> tuple:
    """Points (n, d) [m] of a whole pool that this process makes, and their volumes, (n,) or one [m^d]. Of a lattice it
    makes these alone; a pool that is packed, or stands in rings, it makes as a whole first."""
    d, spacing = case.dimensions, case.resolution.spacing
    if pool.shape == "ring":
        points, volume = lattice.rings(pool.centre, pool.inner_radius, pool.radius, spacing)
    elif "bubble" in case.effects and pool == bubble.pool_of(case):
        points, volume = lattice.pierced(pool.centre, pool.radius, bubble.holes_of(case), spacing)
    elif pool.shape == "tank":
        points, volume = filling.fill(case, pool), spacing**d
    else:
        points, volume = lattice.lattice(pool, spacing, d, world), spacing**d
        if pool.shape == "box":  # the lattice is fitted to the box
            volume = math.prod(b - a for a, b in zip(pool.lower, pool.upper)) / world.sum(len(points))
        return points, volume
    own = slice(*world.ends(len(points)))
    return points[own], volume if np.isscalar(volume) else volume[own]


def _pool(case, pools: list, number: int, world) -> particles.State:
    """The particles of pool `number`, less those that lie in the pools before it, that this process makes."""
    pool, d = pools[number], case.dimensions
    points, volume = _places(case, pool, world)
    taken = []
    for name, earlier in zip(case.pools, pools[:number]):
        left = ~pressures.holds(earlier, points)
        taken += [name] if world.any(not left.all()) else []
        points, volume = points[left], volume if np.isscalar(volume) else volume[left]
    if not world.any(len(points) > 0):
        _refuse_empty(list(case.pools)[number], taken)
    tank.refuse_outside(case, list(case.pools)[number], points, world)
    state = placed(case, points + _raised(pool, points))
    state.kind[:] = GAS if pool.phase == "gas" else LIQUID
    density = pressures.phase_of(case, pool).density
    state.density[:] = _density(case, pool, pressures.at_start(case, pools, number, points, world))
    # two phases fill their space from the start
    state.mass[:] = (state.density if case.gas_phase else density) * volume
    velocity = _velocity(pool, points, d)
    _refuse_fast(case, list(case.pools)[number], velocity, world)
    for array, value in zip((state.u, state.v, state.w), velocity.T):
        array[:] = value
    return state


def _refuse_empty(name: str, taken: list[str]) -> None:
    """CaseError for a pool without a particle, of which those named before it have `taken` the places."""
    if taken:
        others, own = " and ".join(f"[pools.{other}]" for other in taken), f"[pools.{name}]"
        raise CaseError(
            f"pools.{name} holds no particle: pools fill in the order of the case, and {others} before it "
            f"{'takes' if len(taken) == 1 else 'take'} all of its place; put {own} before {others}"
        )
    raise CaseError(f"pools.{name} holds no particle; enlarge it, or give a finer resolution.spacing_mm")


def _refuse_fast(case, name: str, velocity, world) -> None:
    """CaseError where particles of a pool begin faster, velocity (N, d) [m/s], than the liquid's sound, if it has one:
    the guard would stop the run at once."""
    fastest, sound = world.most(float(np.linalg.norm(velocity, axis=1).max(initial=0.0))), case.fastest_sound
    if sound and fastest > sound:
        raise CaseError(
            f"pools.{name} begins at {fastest:.4g} m/s, faster than sound in it ({sound:g} m/s); lower its velocity, "
            f"or raise liquid.sound_speed_m_s to ten times that ({10.0 * fastest:.3g})"
        )


def _density(case, pool, pressure) -> np.ndarray:
    """rho (N,) [kg/m3] at a pressure [Pa] over that at rho_0 without gravity."""
    phase, background = pressures.phase_of(case, pool), case.liquid.background_pressure
    sound = case.gas_phase.speed_of_sound(case.liquid) if pool.phase == "gas" else case.liquid.sound_speed
    cohesion = phase.cohesion if pool.phase == "gas" else 0.0
    total = pressure + background
    density = eos.tait_density(total, phase.density, sound, phase.exponent, background)
    for _ in range(INVERSIONS if cohesion else 0):
        density = eos.tait_density(total + cohesion * density**2, phase.density, sound, phase.exponent, background)
    return density


def _velocity(pool, points, dimensions: int) -> np.ndarray:
    velocity = np.zeros((len(points), dimensions))
    if pool.velocity is not None:
        velocity += np.array(pool.velocity)
    if pool.flow == "rotation":
        middle = 0.5 * (np.array(pool.lower) + np.array(pool.upper))
        omega = 2.0 * pool.speed / (pool.upper[0] - pool.lower[0])
        velocity[:, 0] += omega * (points - middle)[:, 1]
        velocity[:, 1] -= omega * (points - middle)[:, 0]
    if pool.flow == "taylor_green":
        velocity += taylor_green(points, pool.upper[0] - pool.lower[0], pool.speed, 1.0)[0]
    if pool.flow == "quadrupole":
        if pool.centre is None or pool.radius is None:
            raise CaseError('pools: flow = "quadrupole" needs centre_m and radius_m of the disc, in a box too')
        velocity += quadrupole(points - np.array(pool.centre), pool.radius, pool.speed)
    if pool.flow == "wave":
        velocity += _wave(pool, points, pool.speed)
    return velocity


def _raised(pool, points) -> np.ndarray:
    """(N, d) displacement [m] of the particles of a wave at the start."""
    if not pool.displacement:
        return np.zeros_like(points)
    if pool.flow != "wave":
        raise CaseError(f'pools: displacement_m = {pool.displacement:g} is that of a wave; set flow = "wave"')
    return _wave(pool, points, pool.displacement)


def _wave(pool, points, amplitude: float) -> np.ndarray:
    """Wave as long as the box, about the level of the centre, with a crest there."""
    if pool.shape != "box" or pool.centre is None or len(pool.centre) != 2:
        raise CaseError('pools: flow = "wave" needs shape = "box" in two dimensions, and centre_m at a crest')
    return wave(points - np.array(pool.centre), pool.upper[0] - pool.lower[0], amplitude)


def parts_of(case, world=ALONE):
    """Kernel parameters by effect, particles that this process makes, and motion of the frame (or None): all that a run
    begins with."""
    parameters = {row.name: effects.kernel_of(row, case) for row in effects.REGISTRY.values()}
    move = frame.felt(case) if parameters["frame"] else None
    return parameters, fill(case, world), move


def fluids(case) -> np.ndarray:
    """(5, K) rho_0, stiffness, exponent, background and cohesion by kind, as `rates.state_of` takes them."""
    liquid, gas = case.liquid, case.gas_phase
    table = np.ones((5, GAS + 1))
    table[:, LIQUID] = (
        liquid.density,
        liquid.density * liquid.sound_speed**2 / liquid.exponent,
        liquid.exponent,
        liquid.background_pressure,
        0.0,
    )
    if gas:
        stiffness = gas.density * gas.speed_of_sound(liquid) ** 2 / gas.exponent
        table[:, GAS] = gas.density, stiffness, gas.exponent, liquid.background_pressure, gas.cohesion
    return table
