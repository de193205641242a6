"""The sections that a case is made of, and `Case`, all of them together."""

from __future__ import annotations

import dataclasses
import math

from sdph.case.boundary import Boundary
from sdph.case.matter import GasProperties, Grains, Vapour
from sdph.effects import REGISTRY
from sdph.effects.around.nozzles import Nozzle
from sdph.engine.neighbours import SKIN
from sdph.methods.liquids.sections import GasPhase, Liquid, Pool
from sdph.methods.mps.sections import LiquidMethod
from sdph.methods.solids.sections import Body, Solid
from sdph.schema import choice, file, flag, quantity, record, vector, whole, words

OPENINGS = ("inflow", "outflow")  # effects that act on the grains alone where grains and a liquid are side by side
HEATING = {"heat", "conduction", "radiation", "evaporation", "micro_explosion", "reaction", "wall_heat"}


@record
class Run:
    end_time: float = quantity("s", above=0.0)
    output_interval: float = quantity("s", above=0.0)
    step_factor: float = quantity("", 1.0, least=1e-6, most=1e3)  # sub-steps over the largest that the effects allow
    # error that is allowed: decides `effects = "auto"` and warnings
    accuracy: float = quantity("", 0.01, above=0.0, most=1.0)
    # means of the summary and profiles are over the time since then
    average_from: float = quantity("s", 0.0, least=0.0)
    report_at: tuple = vector("s", ())  # times that a window ends at, so that history.csv has them
    metrics: tuple = words(())  # of sdph.running.metrics, for metrics.csv and the summary
    forces: tuple = words(())  # names of sdph.case.forces, on which history.csv and the summary have forces
    checkpoint_interval: float = quantity("s", 600.0, above=0.0)  # of wall time; our choice
    checkpoint_windows: int | None = whole(None, least=1)  # and after so many windows, where it is given
    # what starts the processes of `--ranks N`, which it is told by -n N: "srun", "mpirun --hostfile hosts"; mpirun
    launcher: str = words("")
    device: str = choice("cpu", "cuda")  # where loops over particles run
    # speed from which on a grain has gone unstable; without it ten times all that drives it by the case
    fastest: float | None = quantity("m_s", None, above=0.0)


@record
class Domain:
    """Box of gas or liquid; `gravity` has as many components as the case has dimensions. With an OpenFOAM mesh
    of one's own, `size` and `lower` are those of the box around it where the case leaves them out. Grains that leave
    through a `periodic` side come in again on the other one; no gas solver does that."""

    size: tuple = vector("m")
    gravity: tuple = vector("m_s2")
    lower: tuple | None = vector("m", None)  # lower corner, where that is not the origin
    periodic: tuple = words(())  # axes: "x", "y", "z"

    @property
    def period(self) -> tuple[float, float, float]:
        """Length [m] along the periodic axes, 0 along the others."""
        return tuple(length if axis in self.periodic else 0.0 for axis, length in zip("xyz", (*self.size, 0.0)))

    @property
    def corner(self) -> tuple[float, ...]:
        """Lower corner (d,) [m]."""
        return self.lower or (0.0,) * len(self.size)

    @property
    def upper(self) -> tuple[float, ...]:
        """Upper corner (d,) [m]."""
        return tuple(low + length for low, length in zip(self.corner, self.size))

    @property
    def furthest(self) -> float:
        """Length [m] that no place of it, along any axis, nor any side of it is longer than."""
        return max(*self.size, *map(abs, self.corner), *map(abs, self.upper))

    @property
    def arm(self) -> float:
        """Distance [m] of its furthest corner from the origin."""
        return math.hypot(*(max(abs(low), abs(high)) for low, high in zip(self.corner, self.upper)))


@record
class Resolution:
    spacing: float = quantity("mm", above=0.0)
    smoothing_ratio: float = quantity("", 1.5, least=1.0, most=3.0)  # paper section 4: h is 1.5 spacings
    cell: float | None = quantity("mm", None, above=0.0)  # of the gas; the mean along an axis that is stretched
    # along each axis: width of the last gas cell over the first (blockMesh's simpleGrading)
    stretch: tuple | None = vector("", None)
    # of the kernel's reach: how far neighbour rows look beyond it
    neighbour_skin: float = quantity("", SKIN, least=0.0, most=1.0)


@record
class Region:
    """Region that particles fill at the start: a disc or sphere (centre, radius), a box (lower, upper), a cylinder or a
    cone along an axis about its centre, a polygon of the plane (outline), the inside of a closed mesh, or of the walls.
    What is not in front of `walls.mesh` is left out."""

    shape: str = choice("disc", "sphere", "box", "cylinder", "cone", "outline", "mesh", "walls")
    volume_fraction: float = quantity("", above=0.0, most=1.0)
    temperature: float = quantity("K", above=0.0)
    centre: tuple | None = vector("m", None)
    radius: float | None = quantity("m", None, above=0.0)
    lower: tuple | None = vector("m", None)
    upper: tuple | None = vector("m", None)
    corners: tuple | None = vector("m", None)  # of an outline, one after the other
    axis: str = choice("x", "y", "z", default="z")  # of a cylinder or cone
    length: float | None = quantity("m", None, above=0.0)  # the same; half of it on each side of the centre
    end_radius: float | None = quantity("m", None, least=0.0)  # of a cone, at its upper end; radius is at the lower
    mesh: str = file()  # closed surface mesh of triangles that meshio reads, normals outwards
    mesh_scale: float = quantity("", 1.0, above=0.0)  # metres of a unit of `mesh`: 0.001 where it is in millimetres
    mesh_offset: tuple | None = vector("m", None)  # by which it is moved, after that
    height: float | None = quantity("m", None, above=0.0)  # filled so high over the region's lowest point
    mass: float | None = quantity("kg", None, above=0.0)  # filled from below until so much is there; 2-D: by the metre
    velocity: tuple | None = vector("m_s", None)
    # particles stand off the lattice by up to so many spacings, at random: beds then are not mirror-symmetric
    disorder: float = quantity("", 0.0, least=0.0, most=0.25)
    seed: int = whole(0, least=0)  # of that chance
    material: str = words("")  # of its grains, where there are several


@record
class Probe:
    """A point that `history.csv` follows: `fields` there, of particles and gas; without these the temperatures, of a
    liquid pressure and velocity."""

    at: tuple = vector("m")
    fields: tuple = words(())  # names of sdph.case.probed, such as "pressure"


@record
class Profile:
    """Means over slices across an axis, or over rings about one (`along = "r"`), and over time, of all that a grid of
    gas cells tells of particles and gas: profile_NAME.csv. Without a box all cells count."""

    along: str = choice("x", "y", "z", "r")
    slice: float | None = quantity("m", None, above=0.0)  # thickness; without it a cell's
    lower: tuple | None = vector("m", None)
    upper: tuple | None = vector("m", None)
    axis: str = choice("x", "y", "z", default="z")  # of rings
    centre: tuple | None = vector("m", None)  # a place on that axis


@record
class Part:
    """Part of the walls' surface that lies in a box, as a name of `run.forces`, or with a temperature for the grains
    (sdph.engine.walls.faces)."""

    lower: tuple = vector("m")
    upper: tuple = vector("m")
    temperature: float | None = quantity("K", None, above=0.0)


@record
class Coupling:
    gas: str = choice("auto", "openfoam", "embedded")
    transport: str = choice("socket", "file")
    gas_ranks: int = whole(1, least=1)
    one_way: bool = flag(False)  # the gas acts on the particles and feels nothing
    voidage: bool = flag(True)  # the gas knows of the volume of the grains; false as in point-particle models
    # properties of the gas around a droplet as at (2 T_p + T_g)/3, the third rule: Hubbard, Denny & Mills 1975
    film: bool = flag(False)
    window_tolerance: float = quantity("", 2e-5, above=0.0)  # error of one window over the heat there is to exchange
    window_largest: float = quantity("s", 1e-2, least=1e-15)  # far below what any gas needs; our choice
    courant: float = quantity("", 1.0, least=1e-6)  # of the gas, in one window
    # relative, of the embedded solver; pressure: 1000 times that; our choice
    gas_tolerance: float = quantity("", 1e-11, above=0.0, most=1e-4)


@record
class Case:
    """All that a run needs, in SI. `parameters[name]` holds the section of each effect that is on."""

    title: str
    scene: str
    dimensions: int
    effects: tuple[str, ...]
    run: Run
    domain: Domain
    resolution: Resolution
    gas: GasProperties | None  # None in a case without grains
    grains: Grains | None  # the same; of several materials the first
    materials: dict[str, Grains]  # by name, in the order of the case; none where [grains] is one without a name
    liquid: Liquid | None
    method: LiquidMethod | None  # of the liquid; None: weakly compressible
    gas_phase: GasPhase | None
    solid: Solid | None
    bodies: dict[str, Body]
    pools: dict[str, Pool]
    particles: dict[str, Region]
    boundaries: dict[str, Boundary]
    probes: dict[str, Probe]
    profiles: dict[str, Profile]
    parts: dict[str, Part]
    nozzles: dict[str, Nozzle]
    coupling: Coupling
    vapour: Vapour | None
    track: tuple[str, ...]
    parameters: dict[str, object]

    @property
    def matters(self) -> tuple[str, ...]:
        """Kinds of matter in the case: "grains" (in a gas), "liquid", "solid"; a liquid beside one of the others."""
        given = {"grains": self.grains, "liquid": self.liquid, "solid": self.solid}
        return tuple(matter for matter, section in given.items() if section is not None)

    @property
    def kinds(self) -> tuple[Grains, ...]:
        """Materials of the grains."""
        return tuple(self.materials.values()) or (self.grains,)

    @property
    def mixed(self) -> bool:
        """True where grains are of several materials."""
        return len(self.materials) > 1

    def of(self, name: str) -> Grains:
        """Material of a name; without one that of all grains."""
        return self.materials[name] if name else self.grains

    def number(self, name: str) -> int:
        """Number of a material, counted from 0."""
        return list(self.materials).index(name) if name else 0

    def of_one(self, name: str) -> Case:
        """The case if all grains were of one of its materials: for scales and numbers of each."""
        parts = {
            group: {key: dataclasses.replace(part, material="") for key, part in getattr(self, group).items()}
            for group in ("particles", "nozzles")
        }
        return dataclasses.replace(self, grains=self.materials[name], materials={}, **parts)

    def only(self, matter: str) -> Case:
        """The case without its other matter, and without the effects that act on that alone."""
        if self.matters == (matter,):
            return self
        given = OPENINGS if matter == "liquid" else ()  # to the grains
        kept = tuple(name for name in self.effects if matter in REGISTRY[name].matter and name not in given)
        left = {"effects": kept, "parameters": {name: self.parameters[name] for name in kept}}
        grains = dict.fromkeys(("gas", "grains", "vapour")) | {"track": ()}
        grains |= {group: {} for group in ("particles", "boundaries", "probes", "profiles", "nozzles", "materials")}
        liquid, solid = dict.fromkeys(("liquid", "gas_phase")) | {"pools": {}}, {"solid": None, "bodies": {}}
        others = {"grains": liquid | solid, "liquid": grains | solid, "solid": grains | liquid}
        return dataclasses.replace(self, **left, **others[matter])

    @property
    def incompressible(self) -> bool:
        """True where the liquid is moved by `sdph.methods.mps`."""
        return self.liquid is not None and self.method is not None and self.method.name == "mps"

    def moved_by(self, matter: str) -> str:
        """Name of the method that moves a matter: that of the matter, or "mps"."""
        return "mps" if matter == "liquid" and self.incompressible else matter

    @property
    def liquid_period(self) -> tuple[float, ...]:
        """Length (d,) [m] of each axis that is periodic for a liquid, else 0."""
        on = self.liquid.periodic or (0.0,) * self.dimensions
        return tuple(length * bool(periodic) for length, periodic in zip(self.domain.size, on))

    def vapour_through(self, boundary) -> float:
        """Mass fraction of vapour in the gas that comes in through a boundary: its own, else that of the start."""
        own, start = boundary.vapour_mass_fraction, self.vapour.mass_fraction if self.vapour else 0.0
        return start if own is None else own

    @property
    def smoothing_length(self) -> float:
        return self.resolution.smoothing_ratio * self.resolution.spacing

    @property
    def temperatures(self) -> list[float]:
        """All that the case gives [K]: of the gas, particles, nozzles, boundaries, parts, and `temperatures` of
        sections of effects."""
        parts = *self.particles.values(), *self.nozzles.values(), *self.boundaries.values(), *self.parts.values()
        given = [self.gas.temperature, *(part.temperature for part in parts if part.temperature)]
        return given + [one for own in self.parameters.values() for one in getattr(own, "temperatures", ())]

    @property
    def warm(self) -> bool:
        """True where grains and gas have heat to exchange: temperatures differ, or an effect acts on it."""
        return bool(HEATING & set(self.effects)) or len(set(self.temperatures)) > 1

    @property
    def fastest_sound(self) -> float:
        """The larger sound speed of the phases of a liquid [m/s]; 0 of moving particles, which need none."""
        return max(
            self.liquid.sound_speed or 0.0, self.gas_phase.speed_of_sound(self.liquid) if self.gas_phase else 0.0
        )


SECTIONS = {"run": Run, "domain": Domain, "resolution": Resolution, "gas": GasProperties, "grains": Grains}
GROUPS = {
    "particles": Region, "pools": Pool, "bodies": Body, "boundaries": Boundary, "probes": Probe,
    "profiles": Profile, "parts": Part, "nozzles": Nozzle,
}  # fmt: skip
