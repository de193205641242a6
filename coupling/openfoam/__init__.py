"""OpenFOAM as the gas: finding and building it, writing its cases, running it."""
