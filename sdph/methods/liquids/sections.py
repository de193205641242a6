"""The sections of a case with a liquid: the liquid itself, and the pools of it that there are at the start."""

from __future__ import annotations

from sdph.engine.kernels import NAMES
from sdph.schema import choice, quantity, record, vector, words


@record
class Liquid:
    """A weakly compressible liquid, p = rho_0 c^2/gamma [(rho/rho_0)^gamma - 1] + background."""

    fluid: str = words("")  # of CoolProp: fills density and viscosity where they are left out (sdph.case.fluids)
    fluid_temperature: float = quantity("K", 293.15, above=0.0)  # that they are taken at: ISO 1
    density: float = quantity("kg_m3", above=0.0)
    viscosity: float = quantity("Pa_s", 0.0, least=0.0)
    # ten times the fastest speed or more: liquids.md, shared core; `mps` needs none
    sound_speed: float | None = quantity("m_s", None, above=0.0)
    exponent: float = quantity("", 7.0, least=1.0, most=100.0)
    background_pressure: float = quantity("Pa", 0.0, least=0.0)
    kernel: str = choice(*NAMES)
    # for how neighbours lie (sdph.methods.liquids.correction): shallow liquids, bubbles
    pressure_gradient: str = choice("plain", "corrected")
    courant: float = quantity("", 0.25, least=1e-6, most=0.6)  # of h/(c + v): liquids.md
    history_interval: float | None = quantity("s", None, above=0.0)  # None: a tenth of run.output_interval_s
    periodic: tuple = vector("", ())  # 1 along periodic axes of the domain, 0 along the others

    @property
    def fastest(self) -> float:
        """The speed that the sound speed was chosen for, c/10 [m/s]."""
        return 0.1 * self.sound_speed


@record
class GasPhase:
    """A second phase, a gas or another liquid, lighter or heavier: p = rho_0 c^2/gamma [(rho/rho_0)^gamma - 1] +
    background - cohesion rho^2.

    `interaction`: riemann (sdph.methods.liquids.phases) or plain, p_i + p_j. `density_by`: the continuity equation, or
    a sum over neighbours, of both phases, where the two fill a closed space.
    """

    fluid: str = words("")  # of CoolProp: fills density and viscosity where they are left out (sdph.case.fluids)
    fluid_temperature: float = quantity("K", 293.15, above=0.0)  # that they are taken at: ISO 1
    density: float = quantity("kg_m3", above=0.0)
    viscosity: float = quantity("Pa_s", 0.0, least=0.0)
    sound_speed: float | None = quantity("m_s", None, above=0.0)  # None: that of the liquid (Rezavand, Zhang & Hu 2020)
    exponent: float = quantity("", 1.4, least=1.0, most=100.0)  # of air
    cohesion: float = quantity("Pa_m6_kg2", 0.0, least=0.0)  # of Van der Waals' gas: liquids.md, part L
    interaction: str = choice("riemann", "plain")
    density_by: str = choice("continuity", "summation")

    def speed_of_sound(self, liquid: Liquid) -> float:
        """c [m/s]."""
        return self.sound_speed or liquid.sound_speed


@record
class Pool:
    """A phase at the start: box (lower, upper), disc or sphere (centre, radius), ring (those and inner_radius; in
    circles), or the lowest part of the tank (fill).

    Where pools overlap, the one that is named first has the place: of two pools of the tank, a second one of gas and
    fill = 1 is what the first leaves. The level lies across gravity, or across the last axis where there is none.
    """

    phase: str = choice("liquid", "gas")
    shape: str = choice("box", "disc", "sphere", "ring", "tank")
    lower: tuple | None = vector("m", None)
    upper: tuple | None = vector("m", None)
    centre: tuple | None = vector("m", None)
    radius: float | None = quantity("m", None, above=0.0)
    inner_radius: float | None = quantity("m", None, above=0.0)
    fill: float | None = quantity("", None, above=0.0, most=1.0)
    velocity: tuple | None = vector("m_s", None)
    flow: str = choice("uniform", "rotation", "taylor_green", "quadrupole", "wave")
    # of taylor_green and wave: its amplitude; of rotation: at half the box's side; of quadrupole: at the disc's rim
    speed: float = quantity("m_s", 0.0)
    displacement: float = quantity("m", 0.0)  # of the particles along a wave's flow: its height at the start
