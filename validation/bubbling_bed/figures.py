"""Figures of the bubbling bed beside two fluids, into the run folder."""

from __future__ import annotations

import numpy as np

from sdph.running.metrics import bubble


def _pyplot():
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    return pyplot


def metrics(run, times, own, other) -> None:
    """compare_tfm_metrics.png: what `bubble.metrics` finds, against time [s]; a row of `own` and `other` a time."""
    pyplot = _pyplot()
    keys = (
        "bubble_area_m2",
        "bubble_centroid_m",
        "neck_width_m",
        "gas_temperature_max_K",
        "bed_height_m",
        "pressure_drop_Pa",
    )
    figure, axes = pyplot.subplots(2, 3, figsize=(13, 7), constrained_layout=True)
    for key, axis in zip(keys, axes.ravel()):
        axis.plot(times, [row[key] for row in own], "o-", ms=3, label="SDPH")
        axis.plot(times, [row[key] for row in other], "k--", label="two fluids")
        axis.set(xlabel="time [s]", ylabel=key)
        axis.legend()
    figure.savefig(run.folder / "compare_tfm_metrics.png", dpi=100)
    pyplot.close(figure)


def _image(axis, centres, values, limits):
    """Cell values of a box mesh as squares."""
    order, shape = bubble.rows_of(centres)
    x, y = (centres[order, a].reshape(shape) for a in (0, 1))
    return axis.pcolormesh(x, y, np.asarray(values)[order].reshape(shape), shading="nearest", **limits)


def fields(run, reference, times) -> None:
    """Voidage, gas temperature and grain temperature side by side; upper row SDPH, lower two fluids."""
    pyplot = _pyplot()
    rows = (
        ("alpha_p", "viridis", 0.0, 0.63),
        ("gas_temperature", "inferno", 288.0, 350.0),
        ("particle_temperature", "inferno", 288.0, 290.0),
    )
    figure, axes = pyplot.subplots(
        6, len(times), figsize=(2.6 * len(times), 24), constrained_layout=True, squeeze=False
    )
    for column, t in enumerate(times):
        _, grains, gas = run.fields(t)
        other = reference.fields[reference.nearest(t)]
        for k, (name, colours, low, high) in enumerate(rows):
            limits = {"cmap": colours, "vmin": low, "vmax": high}
            upper, lower = axes[2 * k, column], axes[2 * k + 1, column]
            if name == "gas_temperature":
                shown = _image(upper, gas.cell_centers().points, gas["temperature"], limits)
            else:
                values = grains["alpha_p" if name == "alpha_p" else "temperature"]
                shown = upper.scatter(*grains.points[:, :2].T, c=values, s=1, **limits)
            empty = name == "particle_temperature"
            _image(lower, reference.centres, np.where(empty & (other["alpha_p"] < 0.01), np.nan, other[name]), limits)
            for axis, who in ((upper, "SDPH"), (lower, "two fluids")):
                axis.set(xlim=(0, 0.5), ylim=(0, 0.8), aspect="equal", title=f"{who}, {t:g} s")
            if column == len(times) - 1:
                figure.colorbar(shown, ax=[upper, lower], label=name)
    figure.savefig(run.folder / "compare_tfm.png", dpi=80)
    pyplot.close(figure)
