"""Material of gel droplets: their shell and the vapour of their fuel, as keys of a case and as laws take them."""

from __future__ import annotations

from sdph.laws import real_gas, strength
from sdph.schema import CaseError, choice, fields, quantity, record, vector

EQUATIONS = ("srk", "redlich_kwong_paper")
BAR = 5.0  # decades from bar to Pa
# keys that tell one fuel from another; heat capacity and its ratio may well be alike
MAKING = (
    "molar_mass_kg_kmol", "critical_temperature_K", "critical_pressure_Pa", "acentric_factor", "antoine",
    "latent_heat_J_kg",
)  # fmt: skip


@record
class Shell:
    """Elastic-plastic shell. Defaults: table 1 of Qiang et al. 2017 and, where that has none, gel-droplet.md: n and
    eps_0 of the steel whose constants these are, E for yield at 5 % of strain."""

    youngs_modulus: float = quantity("Pa", 20e6, above=0.0)
    poisson_ratio: float = quantity("", 0.45, least=0.0, most=0.499)
    yield_stress: float = quantity("Pa", 4.9e5, above=0.0)  # A
    hardening: float = quantity("Pa", 8.07e5, least=0.0)  # B
    hardening_exponent: float = quantity("", 0.73, above=0.0, most=10.0)  # n
    rate_factor: float = quantity("", 0.1739, least=0.0, most=10.0)  # C
    reference_rate: float = quantity("1_s", 5e-4, above=0.0)  # eps_0
    failure: tuple = vector("", (0.00705, 1.732, -0.054, -0.0123), components=4)  # D1 to D4
    critical_damage: float = quantity("", 0.012, above=0.0, most=1.0)  # D_c
    flaw: float = quantity("", 0.07, least=0.0, most=0.99)  # share by which a spot is thinner: tears at 1.4 D_0


@record
class Fuel:
    """Vapour of the fuel. Defaults: n-dodecane; saturation of NIST's webbook (Williamham et al. 1945), above 490 K
    extrapolated."""

    equation_of_state: str = choice(*EQUATIONS)
    molar_mass: float = quantity("kg_kmol", 170.33, above=0.0)
    critical_temperature: float = quantity("K", 658.1, above=0.0)
    critical_pressure: float = quantity("Pa", 1.817e6, above=0.0)
    acentric_factor: float = quantity("", 0.574, least=-1.0, most=2.0)
    antoine: tuple = vector("", (4.10549 + BAR, 1625.928, -92.839), components=3)  # of log10(p/Pa)
    latent_heat: float = quantity("J_kg", 2.5e5, above=0.0)
    saturated_heat_capacity: float = quantity("J_kg_K", 2000.0, above=0.0)
    heat_ratio: float = quantity("", 1.02, above=1.0, most=2.0)


def whose(fuel: Fuel) -> tuple[list[str], list[str]]:
    """Keys of a fuel that are not n-dodecane's, and those that are; of numbers, not of the equation of state."""
    default, found = Fuel(), ([], [])
    for key, (name, kind) in fields(Fuel).items():
        if not kind.choices:
            found[getattr(fuel, name) == getattr(default, name)].append(key)
    return found


def mixed(fuel: Fuel, section: str) -> list[str]:
    """A line where some keys that make a fuel are a case's, and others n-dodecane's."""
    own, left = ([key for key in keys if key in MAKING] for keys in whose(fuel))
    if not own or not left:
        return []
    return [
        f"[{section}] gives {', '.join(own)} of a fuel, and {', '.join(left)} are those of n-dodecane: two "
        "fuels in one; give all of the same fuel, unless that is meant"
    ]


def plastic(shell: Shell) -> strength.Plastic:
    """Flow stress of a shell; it does not soften by heat, as its melting point is not given."""
    return strength.Plastic(
        shell.yield_stress, shell.hardening, shell.hardening_exponent, shell.rate_factor, shell.reference_rate, 1.0
    )


def damage(shell: Shell) -> strength.Damage:
    """Damage of a shell, from the first plastic strain on."""
    return strength.Damage(*shell.failure, 1.0, shell.critical_damage, 0.0)


def moduli(shell: Shell) -> tuple[float, float]:
    """K and G [Pa] of a shell."""
    own = shell.youngs_modulus, shell.poisson_ratio
    return strength.bulk_modulus(*own), strength.shear_modulus(*own)


def vapour(fuel: Fuel) -> real_gas.Vapour:
    """Vapour of a fuel by the equation of state that was chosen."""
    paper = fuel.equation_of_state == "redlich_kwong_paper"
    own = real_gas.srk(fuel.critical_temperature, fuel.critical_pressure, fuel.acentric_factor)
    a, b, slope = (*real_gas.PAPER, 0.0) if paper else own
    critical = fuel.critical_temperature
    return real_gas.Vapour(
        int(paper), a, b, critical, slope, *fuel.antoine, fuel.molar_mass, fuel.latent_heat,
        fuel.saturated_heat_capacity, fuel.heat_ratio,
    )  # fmt: skip


def refuse_above_critical(fuel: Fuel, pressure: float, key: str) -> None:
    """`CaseError` where nothing boils: at a pressure [Pa] above the critical one."""
    if pressure >= fuel.critical_pressure:
        raise CaseError(
            f"{key} = {pressure:g}; the fuel's critical pressure is {fuel.critical_pressure:g} Pa: above it nothing "
            "boils and no bubble grows; give a lower pressure, or a weaker shell"
        )
