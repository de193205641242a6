"""A tank's own motion from a table: read from what spreadsheets write, or refused in one line that names the place."""

import numpy as np
import pytest

from sdph.case import read as cases
from sdph.effects.around import frame
from sdph.schema import CaseError

HEAD = ",".join(frame.COLUMNS)
ROWS = ("0.0,0,0,0,0,0,0", "0.5,1,0,0,0,0,0.2", "1.0,3,0,0,0,0,0.6")


def motion(folder, content, until=1.0, **keys):
    """The motion by a table with this content, a text or bytes."""
    file = folder / "motion.csv"
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    return frame.motion(frame.Frame(table=str(file), **keys), until)


def table(*rows, head=HEAD) -> str:
    return "\n".join([head, *rows]) + "\n"


@pytest.mark.parametrize(
    "form", ["plain", "crlf", "bom", "semicolons", "tabs", "spaces", "more columns", "no last newline", "empty lines"]
)
def test_a_table_is_read_as_spreadsheets_write_it(tmp_path, form):
    text = table(*ROWS)
    content = {
        "plain": text,
        "crlf": text.replace("\n", "\r\n"),
        "bom": b"\xef\xbb\xbf" + text.encode(),
        "semicolons": text.replace(",", ";"),
        "tabs": text.replace(",", "\t"),
        "spaces": text.replace(",", " , "),
        "more columns": "\n".join(f"{line},note {n}" for n, line in enumerate(text.splitlines())) + "\n",
        "no last newline": text.rstrip("\n"),
        "empty lines": text.replace("\n", "\n\n"),
    }[form]
    acceleration, omega, rate = motion(tmp_path, content)(0.25)
    np.testing.assert_allclose(acceleration, [0.5, 0.0, 0.0])
    np.testing.assert_allclose(omega, [0.0, 0.0, 0.1])
    np.testing.assert_allclose(rate, [0.0, 0.0, 0.4])


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "it is empty"),
        (b"\n\n", "it is empty"),
        (table(), "two rows at least"),
        (table(ROWS[0]), "two rows at least"),
        (table(ROWS[0], "0.5,1,0"), "line 3 has 3 cells, the first line names 7 columns"),
        (table(ROWS[0], ROWS[1] + ",9"), "line 3 has 8 cells"),
        (table(ROWS[0], "0.5,inf,0,0,0,0,0"), "line 3: ax_m_s2 = inf; it must be finite"),
        (table(ROWS[0], "0.5,nan,0,0,0,0,0"), "line 3: ax_m_s2 = nan; it must be finite"),
        (table(ROWS[0], "0.5,1e999,0,0,0,0,0"), "ax_m_s2 = 1e999; it must be finite"),
        (table(ROWS[0], "0.5,,0,0,0,0,0"), "line 3: ax_m_s2 = ''; it must be a number"),
        (table(ROWS[0], "0.5,fast,0,0,0,0,0"), "line 3: ax_m_s2 = 'fast'; it must be a number"),
        (
            table(ROWS[0], "0,5;1;0;0;0;0;0").replace(",", ";").replace("0;5", "0,5"),
            "time_s = '0,5'; it must be a number, with a point",
        ),
        (table(*reversed(ROWS)), "line 3: time_s = 0.5 is not after 1"),
        (table(ROWS[0], ROWS[0]), "line 3: time_s = 0 is not after 0"),
        (table(ROWS[0], "0.5,1e30,0,0,0,0,0"), "line 3: ax_m_s2 = 1e+30"),
        (table(*ROWS, head=HEAD.replace("az_m_s2", "az")), "no column az_m_s2"),
        (table(*ROWS, head=HEAD.replace("az_m_s2", "ay_m_s2")), "two columns have the same name"),
        ("sep=;\n" + table(*ROWS), "no column time_s"),
        (bytes(range(256)) * 8, "no text in UTF-8"),
        (table(*ROWS).encode("utf-16"), "no text in UTF-8"),
        ("\0" * 4000, "no column time_s"),
        (HEAD + "\n" + '"' + "x" * 200_000, "line "),
    ],
)
def test_a_table_that_is_none_is_refused_in_one_line(tmp_path, content, told):
    with pytest.raises(CaseError) as caught:
        motion(tmp_path, content)
    message = str(caught.value)
    assert told in message and "frame.table" in message and "motion.csv" in message
    assert len(message.splitlines()) == 1 and len(message) < 400


@pytest.mark.parametrize("name", ["", "none.csv", "/dev/zero"])
def test_what_is_no_file_is_refused(tmp_path, name):
    with pytest.raises(CaseError, match="there is no such file"):
        frame.motion(frame.Frame(table=str(tmp_path / name)), 1.0)


def test_a_table_of_gigabytes_is_refused_before_it_is_read(tmp_path):
    with open(tmp_path / "motion.csv", "wb") as file:
        file.truncate(3 * 2**30)
    with pytest.raises(CaseError, match="it has 3221225472 bytes; at most 33554432 are allowed"):
        frame.motion(frame.Frame(table=str(tmp_path / "motion.csv")), 1.0)


def test_the_frame_is_at_rest_before_its_table_and_after_its_end(tmp_path):
    move = motion(tmp_path, table(*ROWS[1:]), until=9.0, start=2.0, end=2.8)
    for time in (0.0, 1.9, 2.4, 2.81, 9.0):
        assert not np.any(move(time))
    np.testing.assert_allclose(move(2.75)[0], [2.0, 0.0, 0.0])


@pytest.mark.parametrize("end", [1.0, 2.0])
@pytest.mark.parametrize("moved", ["shake", "table"])
def test_a_frame_that_ends_before_it_starts_is_refused(tmp_path, moved, end):
    """As a drain is: the tank would never move."""
    file = tmp_path / "motion.csv"
    file.write_text(table(*ROWS))
    own = {"shake": ((0, 0.02, 5.0, 0.3),)} if moved == "shake" else {"table": str(file)}
    with pytest.raises(CaseError, match=rf"frame\.end_s = {end:g} must come after frame\.start_s = 2"):
        frame.motion(frame.Frame(start=2.0, end=end, **own), 1.0)


def test_a_table_that_ends_before_the_run_is_refused(tmp_path):
    with pytest.raises(CaseError, match=r"ends at 3 s and the run at 3\.5 s; add rows.*frame\.end_s"):
        motion(tmp_path, table(*ROWS), until=3.5, start=2.0)
    with pytest.raises(CaseError, match="ends at 3 s"):
        motion(tmp_path, table(*ROWS), until=3.5, start=2.0, end=3.2)
    assert np.any(motion(tmp_path, table(*ROWS), until=3.0, start=2.0)(3.0))


def test_forces_of_a_frame_by_cross_products():
    """-a - domega/dt x r - omega x (omega x r) - 2 omega x v, of numbers that are all different."""
    own = np.random.default_rng(3)
    for _ in range(5):
        a, omega, rate, r, v = own.normal(size=(5, 3))
        expected = -a - np.cross(rate, r) - np.cross(omega, np.cross(omega, r)) - 2.0 * np.cross(omega, v)
        p = frame.FrameP(**dict(zip(("ax", "ay", "az", "wx", "wy", "wz", "bx", "by", "bz"), (*a, *omega, *rate))))
        np.testing.assert_allclose(frame.acceleration(p, *r, *v), expected, rtol=1e-12)
    assert frame.acceleration((), *r, *v) == (0.0, 0.0, 0.0)


def test_a_harmonic_motion_is_the_derivative_of_itself():
    """Amplitude, frequency and phase of each axis: the place's second derivative, and the rate of the turning."""
    shake, turn = ((0, 0.02, 5.0, 0.3), (2, 0.01, 3.0, 1.0)), ((1, 0.4, 2.0, 0.7),)
    move = frame.motion(frame.Frame(shake=shake, turn=turn, spin=(0.0, 0.0, 0.5), start=1.0), 9.0)
    acceleration, omega, rate = move(2.5)
    expected = [-0.02 * 25.0 * np.sin(7.5 + 0.3), 0.0, -0.01 * 9.0 * np.sin(4.5 + 1.0)]
    np.testing.assert_allclose(acceleration, expected, rtol=1e-12)
    np.testing.assert_allclose(omega, [0.0, 0.4 * np.sin(3.7), 0.5], rtol=1e-12)
    np.testing.assert_allclose(rate, [0.0, 0.8 * np.cos(3.7), 0.0], rtol=1e-12)
    assert not any(np.any(part) for part in move(0.9))


TANK = {
    "dimensions": 2, "effects": ["gravity", "frame", "tank", "density_diffusion", "liquid_damping"],
    "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
    "domain": {"size_m": [1.0, 1.0], "gravity_m_s2": [0.0, -9.81]}, "resolution": {"spacing_mm": 50.0},
    "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 30.0},
    "pools": {"water": {"shape": "tank", "fill": 0.5}},
}  # fmt: skip


@pytest.mark.parametrize(("turns", "sideways"), [("space", 9.81 * np.sin(0.6)), ("tank", 0.0)])
def test_gravity_pulls_to_the_lower_side_of_a_tank_that_is_tipped_over(turns, sideways):
    """By 0.6 rad, counterclockwise: down is then to the left of the tank. The acceleration of the frame is the
    opposite of what is felt."""
    move = frame.felt(cases.from_table(TANK | {"frame": {"spin_rad_s": [0.0, 0.0, 1.2], "gravity": turns}}))
    felt = np.array([0.0, -9.81, 0.0]) - move(0.5)[0]
    np.testing.assert_allclose(felt[:2], [-sideways, -9.81 if turns == "tank" else -9.81 * np.cos(0.6)])


@pytest.mark.parametrize(
    "own", [{"turn": [[0, 0.1, 1.0, 0.0]]}, {"spin_rad_s": [0.0, 1.0, 0.0]}, {"shake": [[2, 0.1, 1.0, 0.0]]}]
)
def test_a_plane_tank_does_not_move_out_of_its_plane(own):
    with pytest.raises(CaseError, match="in two dimensions it moves along axes 0 and 1 and turns about axis 2"):
        frame.felt(cases.from_table(TANK | {"frame": own}))
