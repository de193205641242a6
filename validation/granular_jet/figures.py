"""Figures of the stream of agitated grains beside two fluids, into the run folder."""

from __future__ import annotations

import numpy as np

HISTORIES = ("rise_m", "motion_J", "agitation_J", "spread_x_m")
FIELDS = {  # name -> colours, least and largest value shown
    "alpha_p": ("viridis", 0.1, 0.3),
    "velocity": ("coolwarm", -0.6, 0.6),  # m/s, along the stream
    "theta": ("inferno", 0.0, 0.15),  # m2/s2
}
OF_CELLS = {"velocity": "particle_velocity", "theta": "granular_temperature"}  # their names in a two-fluid run
ALONG = 1  # axis of the stream


def _pyplot():
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    return pyplot


def histories(run, times, own, other) -> None:
    """compare_tfm_metrics.png: metrics against time [s]; a row of `own` and `other` a time."""
    pyplot = _pyplot()
    figure, axes = pyplot.subplots(1, len(HISTORIES), figsize=(4 * len(HISTORIES), 3.2), constrained_layout=True)
    for key, axis in zip(HISTORIES, axes):
        axis.plot(times, [row[key] for row in own], "o-", ms=3, label="SDPH")
        axis.plot(times, [row[key] for row in other], "k--", label="two fluids")
        axis.set(xlabel="time [s]", ylabel=key)
        axis.legend()
    figure.savefig(run.folder / "compare_tfm_metrics.png", dpi=80)
    pyplot.close(figure)


def fields(run, reference, times) -> None:
    """compare_tfm.png: volume fraction, velocity along the stream and granular temperature, a pair of columns a time:
    left SDPH, right two fluids."""
    pyplot = _pyplot()
    shape = (len(FIELDS), 2 * len(times))
    figure, axes = pyplot.subplots(*shape, figsize=(1.6 * shape[1], 8.2), constrained_layout=True, squeeze=False)
    for column, time in enumerate(times):
        _, grains, _ = run.fields(time)
        other = reference.fields[reference.nearest(time)]
        for row, (name, (colours, low, high)) in zip(axes[:, 2 * column : 2 * column + 2], FIELDS.items()):
            shown = {"cmap": colours, "vmin": low, "vmax": high}
            own, there = _values(grains, other, name)
            row[0].scatter(*grains.points[:, :2].T, c=own, s=2, **shown)
            image = row[1].scatter(*reference.centres[:, :2].T, c=there, s=5, marker="s", **shown)
            for axis, who in zip(row, ("SDPH", "two fluids")):
                axis.set(aspect="equal", xticks=[], yticks=[], title=f"{who}, {time:g} s")
                axis.title.set_fontsize(7)
            if column == len(times) - 1:
                figure.colorbar(image, ax=row[1], label=name)
    figure.savefig(run.folder / "compare_tfm.png", dpi=80)
    pyplot.close(figure)


def _values(grains, other, name: str):
    """A field of the particles (N,) and of the cells (C,); of a velocity the part along the stream."""
    own = np.asarray(grains[name])
    there = other[OF_CELLS.get(name, name)]
    return (own[:, ALONG], there[:, ALONG]) if own.ndim == 2 else (own, there)
