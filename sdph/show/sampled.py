"""Fields at any points: of particles by the sum of SPH (VTK's point interpolation), of gas by the cell that holds the
point."""

from __future__ import annotations

import numpy as np

REACH = 1.1  # smoothing length of pictures over the spacing: no gaps, and little is blurred; our choice
INSIDE = 0.5  # sum of volume and kernel at a plane surface of a liquid
GRAIN = 2.0  # points of a grid in space, by the spacing; our choice: a finer one shows no more


def grid(box: np.ndarray, step: float):
    """Points (pyvista.ImageData) about `step` [m] apart that fill a box (6,) [m] with two steps to spare; one layer
    where the box is flat."""
    import pyvista

    low, high = np.reshape(box, (3, 2)).T
    flat = high <= low
    count = np.where(flat, 1, np.ceil((high - low) / step).astype(int) + 5)
    origin = np.where(flat, low, low - 2.0 * step)
    return pyvista.ImageData(dimensions=count, spacing=(step, step, step), origin=origin)


def of_particles(points, places: np.ndarray, volumes: np.ndarray, arrays: dict, h: float, dimensions: int):
    """(values by name, share): of particles at `places` (N, 3) with `volumes` (N,) [m^d] at the points of a pyvista
    mesh: sum V f W / sum V W, nan where there is none, and sum V W itself."""
    import pyvista
    from vtkmodules import vtkFiltersPoints as vtk

    if not len(places):
        return {name: np.full(points.n_points, np.nan) for name in arrays}, np.zeros(points.n_points)
    cloud = pyvista.PolyData(np.ascontiguousarray(places, float))
    cloud["mass"], cloud["density"] = np.ascontiguousarray(volumes, float), np.ones(len(volumes))
    for name, values in arrays.items():
        cloud[f"of {name}"] = np.ascontiguousarray(values, float)
    kernel = vtk.vtkSPHCubicKernel()
    kernel.SetDimension(dimensions)
    kernel.SetSpatialStep(h)
    summed = vtk.vtkSPHInterpolator()
    summed.SetInputData(points)
    summed.SetSourceData(cloud)
    summed.SetKernel(kernel)
    summed.SetMassArrayName("mass")
    summed.SetDensityArrayName("density")
    summed.SetComputeShepardSum(True)
    summed.SetShepardNormalization(True)
    summed.Update()
    found = pyvista.wrap(summed.GetOutput())
    share = np.asarray(found["Shepard Summation"])
    none = share <= 0.0
    values = {name: np.array(found[f"of {name}"]) for name in arrays}
    for own in values.values():
        own[none] = np.nan
    return values, share


def of_cells(gas, places: np.ndarray, field: str) -> np.ndarray:
    """Values (P,) or (P, k) of the gas at `places` (P, 3) [m]: those of the cell there, nan outside."""
    values, numbers = np.asarray(gas.cell_data[field], float), cells_at(gas, places)
    found = values[np.maximum(numbers, 0)]
    found[numbers < 0] = np.nan
    return found


def between_cells(gas, places: np.ndarray, field: str) -> np.ndarray:
    """The same interpolated: the mean of the cells at each corner, linear in between."""
    import pyvista

    found = pyvista.PolyData(np.ascontiguousarray(places)).sample(gas.cell_data_to_point_data(), tolerance=_slack(gas))
    values = np.array(found[field], float)
    values[np.asarray(found["vtkValidPointMask"]) == 0] = np.nan
    return values


def cells_at(gas, places: np.ndarray) -> np.ndarray:
    """(P,) number of the cell of the gas that holds each of `places` (P, 3) [m]; -1 outside."""
    return _of_boxes(gas, places) if gas.GetClassName() == "vtkRectilinearGrid" else _of_any(gas, places)


def _of_boxes(gas, places) -> np.ndarray:
    """The number where cells are boxes."""
    number, outside, stride = np.zeros(len(places), int), np.zeros(len(places), bool), 1
    for along, ticks in zip(places.T, (np.asarray(gas.x), np.asarray(gas.y), np.asarray(gas.z))):
        if len(ticks) > 1:
            own = np.searchsorted(ticks, along, side="right") - 1
            own[along == ticks[-1]] = len(ticks) - 2
            outside |= (own < 0) | (own > len(ticks) - 2)
            number += stride * np.clip(own, 0, len(ticks) - 2)
            stride *= len(ticks) - 1
    return np.where(outside, -1, number)


def _of_any(gas, places) -> np.ndarray:
    """The same of cells of any kind, by VTK."""
    import pyvista

    numbered = gas.copy(deep=False)
    numbered.clear_data()
    numbered.cell_data["number"] = np.arange(gas.n_cells, dtype=float)
    found = pyvista.PolyData(np.ascontiguousarray(places)).sample(numbered, tolerance=_slack(gas))
    inside = np.asarray(found["vtkValidPointMask"]) > 0
    return np.where(inside, np.rint(found["number"]).astype(int), -1)


def _slack(gas) -> float:
    """Distance [m] at which a point still is in a cell: a plane mesh of VTK has no thickness."""
    return 1e-6 * gas.length
