"""What is free goes straight: a path in a frame that is shaken and turned about all axes, with the code's forces, seen
from a frame at rest."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from sdph.effects.around import frame

SHAKE = ((0, 0.3, 2.0, 0.4), (1, 0.2, 3.0, 1.1), (2, 0.25, 1.5, 2.0))
TURN = ((0, 0.7, 1.3, 0.2), (1, 0.5, 2.1, 0.9), (2, 0.8, 1.7, 2.3))
SPIN = (0.4, -0.3, 0.5)
END = 2.0  # s


def strayed(force) -> float:
    """How far a free body is from its straight line at END, over the way that its forces in the frame would take it."""
    move = frame.motion(frame.Frame(shake=SHAKE, turn=TURN, spin=SPIN), END)
    place, speed = np.array([0.3, -0.2, 0.5]), np.array([0.6, 0.4, -0.7])

    def rates(t, y):
        """Place and velocity in the frame; its axes (3, 3) as columns, its origin and the velocity of that at rest."""
        r, v, axes, drift = y[:3], y[3:6], y[6:15].reshape(3, 3), y[18:21]
        a, omega, rate = move(t)
        felt = force(frame.FrameP(*a, *omega, *rate), *r, *v)
        turning = axes @ np.cross(np.eye(3), omega)  # column j: axes (omega x e_j), as cross(e_k, omega)_j
        return np.concatenate((v, felt, turning.ravel(), drift, axes @ a))

    omega = move(0.0)[1]
    start = np.concatenate((place, speed, np.eye(3).ravel(), np.zeros(6)))
    end = solve_ivp(rates, (0.0, END), start, rtol=1e-11, atol=1e-12).y[:, -1]
    seen = end[15:18] + end[6:15].reshape(3, 3) @ end[:3]
    straight = place + END * (speed + np.cross(omega, place))
    felt = frame.acceleration(frame.FrameP(*np.concatenate(move(0.0))), *place, *speed)
    return np.linalg.norm(seen - straight) / (0.5 * END**2 * np.linalg.norm(felt))


def test_what_is_free_goes_straight():
    assert strayed(frame.acceleration) < 1e-6


def planted() -> list:
    """The function with the sign of one of its terms turned: acceleration, Euler, centrifugal and Coriolis along each
    axis."""
    text = Path(frame.__file__).read_text(encoding="utf-8")
    text = text[text.index("def acceleration(") : text.index("def kernel(")]
    found = []
    for line in re.findall(r"^    a[xyz] = .*$", text, re.MULTILINE):
        for sign in (
            k for k, letter in enumerate(line) if letter == "-" and line.count("(", 0, k) == line.count(")", 0, k)
        ):
            found.append(text.replace(line, f"{line[:sign]}+{line[sign + 1 :]}"))
    return found


@pytest.mark.parametrize("number", range(12))
def test_no_sign_can_be_turned(number):
    space = {}
    exec(planted()[number], space)  # of our own source
    assert strayed(space["acceleration"]) > 1e-3


def test_all_terms_are_turned():
    assert len(set(planted())) == 12
