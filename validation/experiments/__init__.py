"""Measurements of others, and what we have there: an experiment is a module with `checks(folder, overrides,
reporter)`, whose runs and figure go to `folder`, and `sdph validate experiments` calls them all.

packed_bed                 Ergun 1952: friction of gas in a bed, from runs
minimum_fluidisation       Geldart 1973: U_mf of 22 powders, laws alone
liquid_fluidisation        Richardson & Zaki 1954: index n, laws alone
water_drops                Ranz & Marshall 1952: rate of evaporation and wet bulb, from runs
heptane_drops              Nomura et al. 1996: d^2 of heptane in hot nitrogen, from runs
humid_drops                Fujita et al. 2010: d^2 and temperature of water in dry and humid air, from runs
micro_drops                Taflin et al. 1988: d^2 of micrometric water drops, from runs
bed_transfer               Wakao & Funazkri 1978: Sherwood numbers of packed beds, laws alone
heated_bed                 Beaulieu 2020: temperature in a packed bed of steel, from runs
"""

NAMES = (
    "packed_bed",
    "minimum_fluidisation",
    "liquid_fluidisation",
    "water_drops",
    "heptane_drops",
    "humid_drops",
    "micro_drops",
    "bed_transfer",
    "heated_bed",
)
