"""Contact with a body whose surface bends away from the grains: a tube, or a block with edges."""

import meshio
import numpy as np
import pytest
from grain_boxes import SPACING, box, started

from sdph.effects.around import wall_contact

MIDDLE, FAR = 0.08, 0.3  # m, and spacings before the surface, where contact at 0.25 leaves a grain alone
SIDES = 480  # of a tube


def about(tmp_path, corners, periodic=("x", "y")):
    """The stepper of grains about a body of lines between corners (n, 2) [m], clockwise."""
    count, path = len(corners), tmp_path / "body.vtk"
    lines = np.stack((np.arange(count), (np.arange(count) + 1) % count), axis=1)
    meshio.Mesh(np.column_stack((corners, np.zeros(count))), [("line", lines)]).write(path)
    effects, walls = ["granular_pressure", "walls"], {"mesh": str(path)}
    case = box(effects, size=(0.16, 0.16), periodic=periodic, alpha_p=0.5, walls=walls)
    return started(case, tmp_path).stepper


def tube(tmp_path, radius):
    turn = -2.0 * np.pi * np.arange(SIDES) / SIDES
    return about(tmp_path, MIDDLE + radius * np.stack((np.cos(turn), np.sin(turn)), axis=1))


def put_back(stepper, place):
    """Way (2,) [m] that contact puts a grain back by at a place (2,) [m], rows made anew there."""
    stepper.state.x[0], stepper.state.y[0] = place
    stepper.neighbours.built = ()
    stepper.prepare()
    s = stepper.state
    i = int(np.argmin(np.hypot(s.x - place[0], s.y - place[1])))
    felt, sums = np.zeros((0, len(stepper.wall.x), 6)), (np.zeros(3), np.zeros(1), np.zeros(2))
    wall_contact.stop(*stepper._walls(), stepper.neighbours.box, s, np.zeros(3), *sums, felt)
    return np.array((s.x[i], s.y[i])) - place


@pytest.mark.parametrize("radius", [2.0, 3.0, 6.0])
def test_a_tube_holds_grains_off_as_far_as_a_floor_does(tmp_path, radius):
    """Planes of points a spacing further round the tube would hold them off by up to spacing^2/(2 radius) more."""
    stepper, radius = tube(tmp_path, radius * SPACING), radius * SPACING
    for turn in np.linspace(0.0, 0.5 * np.pi, 37):
        outward = np.array((np.cos(turn), np.sin(turn)))
        sagged = (0.55 * SPACING) ** 2 / (2.0 * radius)  # of the plane half a spacing aside
        far, near = (MIDDLE + (radius + off * SPACING) * outward for off in (0.25, 0.15))
        assert not put_back(stepper, far + sagged * outward).any()
        assert 0.09 * SPACING <= (way := put_back(stepper, near)) @ outward <= 0.11 * SPACING + sagged
        assert abs(way[0] * outward[1] - way[1] * outward[0]) < 0.1 * SPACING


def test_grains_fall_past_the_edge_of_a_block(tmp_path):
    """The plane of its top does not go on beside it."""
    half = 4.0 * SPACING
    corners = MIDDLE + half * np.array([(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)])
    stepper = about(tmp_path, corners)
    for aside in (FAR, 0.6, 0.9):
        for up in np.arange(-1.0, aside - 0.05, 0.05):  # nearer to the side than to the top
            place = np.array((MIDDLE + half + aside * SPACING, MIDDLE + half + up * SPACING))
            assert not put_back(stepper, place).any(), (aside, up)


@pytest.mark.parametrize("deep", [0.0, 0.4, 0.8])
@pytest.mark.parametrize("off", [0.0, 0.2, 0.55, 0.6, 0.8, 0.9])
def test_a_block_on_the_floor_holds_grains_in_the_corner_beside_it(tmp_path, deep, off):
    """Places of the floor below the block lie behind its side, but that lies before the floor: both hold. `deep`
    spacings of the block are below the floor."""
    side, low = 0.08 + off * SPACING, -deep * SPACING
    stepper = about(tmp_path, np.array([(0.04, low), (0.04, 0.04), (side, 0.04), (side, low)]), ())
    for up in (0.25, 0.4):
        put_back(stepper, np.array((side + 0.26 * SPACING, up * SPACING)))
        s = stepper.state
        i = int(np.argmin(np.hypot(s.x - side - 0.26 * SPACING, s.y - up * SPACING)))
        s.x[i] = side + 0.1 * SPACING  # within the rows that were just made
        felt, sums = np.zeros((0, len(stepper.wall.x), 6)), (np.zeros(3), np.zeros(1), np.zeros(2))
        wall_contact.stop(*stepper._walls(), stepper.neighbours.box, s, np.zeros(3), *sums, felt)
        assert s.x[i] - side >= (0.25 - 1e-6) * SPACING
