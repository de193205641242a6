"""Measurements of others, and what we have there: an experiment is a module with `checks(folder, overrides,
reporter)`, whose runs and figure go to `folder`, and `sdph validate experiments` calls them all.

packed_bed                 Ergun 1952: friction of gas in a bed, from runs
minimum_fluidisation       Geldart 1973: U_mf of 22 powders, laws alone
liquid_fluidisation        Richardson & Zaki 1954: index n, laws alone
liquid_beds                Richardson & Zaki 1954: voidage of beds in water, from runs
water_drops                Ranz & Marshall 1952: rate of evaporation and wet bulb, from runs
heptane_drops              Nomura et al. 1996: d^2 of heptane in hot nitrogen, from runs
humid_drops                Fujita et al. 2010: d^2 and temperature of water in dry and humid air, from runs
micro_drops                Taflin et al. 1988: d^2 of micrometric water drops, from runs
bed_transfer               Wakao & Funazkri 1978: Sherwood numbers of packed beds, laws alone
bed_heat                   Wakao & Funazkri 1978: Nusselt number of a packed bed, from runs
heated_bed                 Beaulieu 2020: temperature in a packed bed of steel, from runs
hot_tube                   Zhang et al. 2014, Grewal & Saxena 1980: heat from a tube to a bed, from runs with OpenFOAM
tube_bank                  Grewal 1981: heat from a staggered bank of tubes, from a run with OpenFOAM
bed_pressure               Toomey & Johnstone 1952: pressure drop of fluidised beds, from runs
bed_profiles               Mueller et al. 2009: voidage and velocity across a bubbling bed, from runs
drop_spread                Pasandideh-Fard et al. 1996, Roisman 2009: largest spread of a drop on a wall, from runs
"""

NAMES = (
    "packed_bed",
    "minimum_fluidisation",
    "liquid_fluidisation",
    "liquid_beds",
    "water_drops",
    "heptane_drops",
    "humid_drops",
    "micro_drops",
    "bed_transfer",
    "bed_heat",
    "heated_bed",
    "hot_tube",
    "tube_bank",
    "bed_pressure",
    "bed_profiles",
)
LONG = ("drop_spread",)  # ten minutes, hours where finer: by name alone, `sdph validate experiments.drop_spread`

# record -> how names of its checks begin -> (who measured, what, ours): a table of the dashboard
MEASURED = {
    "experiments": {
        "friction": ("Ergun 1952", "friction of packed beds", "runs"),
        "U_mf": ("Geldart 1973", "minimum fluidisation of powders", "laws"),
        "index n,": ("Richardson & Zaki 1954", "index of liquid fluidisation", "laws"),
        "index n of beds": ("Richardson & Zaki 1954", "index of liquid fluidisation, bed by bed", "laws"),
        "liquid bed": ("Richardson & Zaki 1954", "voidage and index of beds in water", "runs"),
        "drop's rate": ("Ranz & Marshall 1952", "rate of evaporation of water drops", "runs"),
        "drop's temperature": ("Ranz & Marshall 1952", "wet bulb of water drops", "runs"),
        "heptane": ("Nomura et al. 1996", "d^2 of heptane drops in hot nitrogen", "runs"),
        "water drop": ("Fujita et al. 2010", "d^2 and temperature of water drops in humid air", "runs"),
        "micrometric drop": ("Taflin et al. 1988", "d^2 of micrometric water drops", "runs"),
        "transfer in a bed": ("Wakao & Funazkri 1978", "Sherwood numbers of packed beds", "laws"),
        "heat in a packed bed": ("Wakao & Funazkri 1978", "Nusselt number of a packed bed", "runs"),
        "packed steel": ("Beaulieu 2020", "temperature in a heated bed of steel spheres", "runs"),
        "hot tube": ("Zhang et al. 2014, Grewal & Saxena 1980", "heat from a tube to a bed, laws of others", "runs"),
        "tube bank": ("Grewal 1981", "heat from a bank of tubes to a bed, law of others", "runs"),
        "bed of beads": ("Toomey & Johnstone 1952", "pressure drop of fluidised beds", "runs"),
        "bed of seeds": ("Mueller et al. 2009", "voidage and velocity of grains across a bubbling bed", "runs"),
        "spread of a drop": ("Pasandideh-Fard et al. 1996, Roisman 2009", "largest spread of a drop on a wall", "runs"),
    },
    "granular_piles": {
        r"column.*: run-out": ("Lube et al. 2005", "run-out of columns of grains", "runs"),
        "slot": ("Beverloo et al. 1961", "rate out of a slot", "runs"),
    },
    "dam_break": {
        "dam_break, exact": ("Martin & Moyce 1952, Koshizuka & Oka 1996", "front of a collapsing column", "runs")
    },
    "dam_break_3d": {
        "dam_break_3d, exact": ("Martin & Moyce 1952, Koshizuka & Oka 1996", "the same in a channel", "runs"),
        "against a box, spheric": ("Kleefsman et al. 2005", "water against a box: heights, pressure", "runs"),
    },
    "dam_break_gas": {
        "dam_break_gas, exact: front": ("Martin & Moyce 1952, Koshizuka & Oka 1996", "the same with air", "runs"),
    },
    "capillary_wave": {"capillary_wave, exact": ("Prosperetti 1981, exact", "height of a capillary wave", "runs")},
}
