"""The period of a signal that rings down."""

from __future__ import annotations

import numpy as np
import scipy


def ringing(time, signal, guess: float) -> tuple[float, float]:
    """(omega [rad/s], damping [1/s]) of a + exp(-b t) (c cos + d sin)(omega t) fitted to a signal; `guess` of omega."""

    def model(t, mean, damping, omega, cosine, sine):
        return mean + np.exp(-damping * t) * (cosine * np.cos(omega * t) + sine * np.sin(omega * t))

    t = time - time[0]
    start = (signal.mean(), 0.05, guess, np.ptp(signal) / 2.0, np.ptp(signal) / 2.0)
    fitted, _ = scipy.optimize.curve_fit(model, t, signal, p0=start, maxfev=20000)
    return abs(float(fitted[2])), float(fitted[1])
