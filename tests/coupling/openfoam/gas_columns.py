"""Columns of gas for tests of sdphGasFoam."""

from gas_boxes import AIR

RHO, CP = AIR["density_kg_m3"], AIR["heat_capacity_J_kg_K"]
OPEN = {"all": {"kind": "pressure_outlet", "pressure_Pa": 0.0}}


def gas_volume(gas):
    return gas.mesh.volumes.sum()
