"""Constants of nature and of the closures: name, value, unit, source."""

GAS_CONSTANT = 8314.46261815324  # J/(kmol K), 1000 k_B N_A, exact since the SI of 2019 (CODATA 2018)
STEFAN_BOLTZMANN = (
    5.670374419e-8  # W/(m2 K4), 2 pi^5 k_B^4/(15 h^3 c^2), exact since the SI of 2019 (CODATA 2018, rounded)
)
ADIABATIC = 1.4  # -, cp/cv of a diatomic gas whose molecules turn and do not swing
VACUUM_PERMITTIVITY = 8.8541878128e-12  # F/m, eps_0 (CODATA 2018)

# -, closures are evaluated at most this far below close packing (1/(1-(a/a_max)^(1/3)) has a pole there)
PACKING_MARGIN = 0.01
SOFTENING = 0.01  # -, eta^2/h^2 in r^2 + eta^2, keeps coincident pairs finite (Monaghan 1992; Cleary & Monaghan 1999)
# -, of sqrt(rho l^3/(2 pi sigma)), the time of a capillary wave of length l: Adami, Hu & Adams 2010, JCP 229, 5011
CAPILLARY = 0.25

# Friction of grains: Johnson & Jackson 1987, with the constants of OpenFOAM's tutorials (Johnson-Jackson model)
FRICTION_FR = 0.05  # Pa
FRICTION_ETA = 2.0  # -
FRICTION_P = 5.0  # -

TINY = 1e-300  # keeps a quotient finite whose numerator vanishes with its denominator, without a branch; our choice

# Relative, all our choice
ROUND_OFF = 1e-9  # numbers that differ by less differ by round-off of sums alone
SAME = 1e-6  # places that were found each in its own way, by turns and roots, and differ by less are the same
CONVERGED = 1e-14  # a step of Newton's method that is shorter than that of the root is the last one
HALVINGS = 60  # of an interval, down to round-off
