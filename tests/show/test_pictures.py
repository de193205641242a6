"""Pictures: one scale for grains and gas, particles without gaps and to their size, surfaces where the liquid ends."""

from dataclasses import replace

import numpy as np
import pytest
import pyvista

from sdph import scenes
from sdph.case import read as cases
from sdph.schema import CaseError
from sdph.show import canvas, eye, flat, raster, sampled, shot, space, style, timeline, view, window
from sdph.show.look import Look, coloured, rgb

SPACING = 0.1


def cloud(places, **arrays):
    """Particles of a liquid, one for each spacing."""
    places = np.asarray(places, float)
    if places.shape[1] == 2:
        places = np.column_stack((places, np.zeros(len(places))))
    made = pyvista.PolyData(places)
    deep = 3 if np.ptp(places[:, 2]) else 2
    made["mass"], made["density"] = np.full(len(places), 1000.0 * SPACING**deep), np.full(len(places), 1000.0)
    made["kind"], made["velocity"] = np.full(len(places), 2), np.zeros((len(places), 3))
    for name, values in arrays.items():
        made[name] = values
    return made


def lattice(count, dimensions=2):
    ticks = (np.arange(count) + 0.5) * SPACING
    return np.stack(np.meshgrid(*[ticks] * dimensions, indexing="ij"), axis=-1).reshape(-1, dimensions)


def cells(field="temperature", function=lambda x: x[:, 0]):
    gas = pyvista.RectilinearGrid(np.linspace(0.0, 1.0, 5), np.linspace(0.0, 2.0, 9), np.zeros(1))
    gas.cell_data[field] = function(gas.cell_centers().points)
    return gas


def taken(particles, gas=None, walls=None, case=None):
    return shot.of_state(timeline.Instant(0.5, particles, gas), case, walls)


def test_one_scale_is_of_grains_and_gas():
    """The same value has the same colour on both: bounds are those of both together."""
    both = taken(cloud(lattice(3), temperature=np.full(9, 250.0)), cells(function=lambda x: 300.0 + x[:, 1]))
    scale = style.scale("temperature", both.values("temperature"))
    assert (scale.low, scale.high) == pytest.approx((250.0, 301.875))
    theme = style.THEMES["light"]
    assert np.array_equal(coloured([275.0], scale, theme), coloured(np.array([[275.0]]), scale, theme)[0])
    assert coloured([np.nan], scale, theme)[0] == pytest.approx(rgb(theme.void))


@pytest.mark.parametrize(
    ("field", "values", "title", "low", "high", "extend"),
    [
        ("pressure", np.linspace(-2e3, 5e3, 50), "pressure [kPa]", -2.0, 5.0, "neither"),
        ("pressure", np.linspace(101325.0, 101345.0, 50), "pressure above 101 kPa [Pa]", 325.0, 345.0, "neither"),
        ("diameter", np.linspace(1e-5, 7e-4, 50), "diameter [mm]", 0.01, 0.7, "neither"),
        ("velocity", np.linspace(0.5, 2.0, 50), "speed [m/s]", 0.0, 2.0, "neither"),
        ("velocity", np.linspace(20.0, 28.0, 50), "speed [m/s]", 20.0, 28.0, "neither"),
        ("vorticity", np.linspace(-1.0, 4.0, 50), "vorticity [1/s]", -4.0, 4.0, "neither"),
        ("pressure", np.append(np.linspace(0.0, 1.0, 999), 500.0), "pressure [Pa]", 0.005, 0.995, "both"),
    ],
)
def test_scales_have_units_with_few_digits_and_tell_what_lies_beyond(field, values, title, low, high, extend):
    scale = style.scale(field, [values])
    assert (scale.title, scale.extend) == (title, extend)
    assert (scale.low, scale.high) == pytest.approx((low, high), abs=2e-3 * (high - low))
    assert scale.shown(values[0]) == pytest.approx((values[0] - scale.origin) / scale.factor)


def test_gas_at_rest_is_drawn_at_rest():
    """Round-off made stripes under a bar of zeros."""
    still, slow = (style.scale("velocity", [np.array([0.0, speed])]) for speed in (8e-17, 2e-6))
    assert (still.high, still.factor, slow.high) == (1.0, 1.0, 2e-6)


def test_a_field_of_one_value_or_none_has_a_scale():
    for values in ([np.full(3, 5.0)], [np.full(3, np.nan)], []):
        scale = style.scale("temperature", values)
        assert scale.high > scale.low


@pytest.mark.parametrize(("value", "text"), [(0.0036666, "0.00367"), (1234.0, "1230"), (-2.0, "-2"), (1e-15, "0")])
def test_numbers_have_three_digits(value, text):
    assert style.digits(value) == text


def test_a_lattice_is_drawn_without_gaps_and_a_lone_particle_to_its_size():
    whole = taken(cloud(np.vstack((lattice(10), [[3.0, 0.5]]))))
    grid = raster.pixels(whole, 1600)
    _, covered, light = raster.particles(whole, grid, "velocity", smooth=False)
    x, y = grid.places[..., 0], grid.places[..., 1]
    assert covered[(x > 0.05) & (x < 0.95) & (y > 0.05) & (y < 0.95)].all()
    area = covered.sum() * np.prod(grid.step)
    assert area == pytest.approx(101 * SPACING**2, rel=0.02)
    alone = covered[x > 2.0].sum() * np.prod(grid.step)
    assert alone == pytest.approx(np.pi * (0.55 * SPACING) ** 2, rel=0.05)
    assert not light.any()


def test_gaps_of_a_torn_lattice_are_closed_and_holes_stay():
    """Particles a fifth farther apart are still one liquid; where nine are missing there is a hole."""
    places = 1.2 * lattice(12)
    middle = places.mean(axis=0)
    torn = taken(cloud(places[np.abs(places - middle).max(axis=1) > 0.2]))
    grid = raster.pixels(torn, 1200)
    covered = raster.particles(torn, grid, "velocity", smooth=False)[1]
    far = np.abs(grid.places[..., :2] - middle).max(axis=-1)
    assert covered[(far > 0.35) & (far < 0.6)].all() and not covered[far < 0.1].any()


def test_a_smooth_field_is_the_field_up_to_the_surface():
    places = lattice(12)
    steep = taken(cloud(places, pressure=3.0 * places[:, 0] - places[:, 1]))
    grid = raster.pixels(steep, 700)
    values, covered, _ = raster.particles(steep, grid, "pressure", smooth=True)
    x, y = grid.places[..., 0], grid.places[..., 1]
    inside = (np.abs(x - 0.6) < 0.35) & (np.abs(y - 0.6) < 0.35)
    assert values[inside] == pytest.approx((3.0 * x - y)[inside], abs=0.02)
    assert covered.sum() * np.prod(grid.step) == pytest.approx(1.2**2, rel=0.03)


@pytest.mark.parametrize("smooth", [False, True])
def test_no_grains_are_drawn_where_a_body_in_the_gas_stands(smooth):
    """A body as wide as two grains, out of which the mesh of the gas is cut."""
    places, half = lattice(10), SPACING
    aside = np.abs(places - 0.5).max(axis=1)
    ticks = np.arange(0.0, 1.01, 0.5 * SPACING)
    whole = pyvista.RectilinearGrid(ticks, ticks, np.zeros(1))
    gas = whole.extract_cells(np.abs(whole.cell_centers().points[:, :2] - 0.5).max(axis=1) > half)
    walls = pyvista.Box((0.5 - half, 0.5 + half, 0.5 - half, 0.5 + half, 0.0, 0.0))
    around = taken(cloud(places[aside > half], pressure=places[aside > half, 0]), gas, walls)
    grid = raster.pixels(around, 500)
    values, covered, _ = raster.particles(around, grid, "pressure", smooth=smooth)
    body = np.abs(grid.places[..., :2] - 0.5).max(axis=-1) < 0.95 * half
    assert not covered[body].any() and np.isnan(values[body]).all()
    assert covered[np.abs(grid.places[..., :2] - 0.5).max(axis=-1) > 1.3 * half].mean() > 0.95


def test_cells_are_found_where_they_are():
    gas = cells(function=lambda x: x[:, 0] + 10.0 * x[:, 1])
    centres = gas.cell_centers().points
    found = sampled.of_cells(gas, np.vstack((centres, [[-0.1, 0.5, 0.0], [1.0, 2.0, 0.0]])), "temperature")
    assert found[:-2] == pytest.approx(gas.cell_data["temperature"])
    assert np.isnan(found[-2]) and found[-1] == gas.cell_data["temperature"][-1]
    any_mesh = gas.cast_to_unstructured_grid()
    assert sampled.of_cells(any_mesh, centres, "temperature") == pytest.approx(found[:-2])
    between = sampled.between_cells(gas, np.array([[0.5, 1.0, 0.0]]), "temperature")
    assert between == pytest.approx([10.5], abs=1e-6)


def test_the_far_side_of_a_vessel_is_drawn_whatever_its_normals():
    outwards = pyvista.Cylinder(resolution=20)
    assert space._near_side(outwards) == "front"
    assert space._near_side(outwards.flip_faces()) == "back"


@pytest.mark.parametrize(("edges", "axes"), [((5, 9, 1), (0, 1)), ((1, 9, 5), (1, 2)), ((5, 9, 8), None)])
def test_a_slab_is_looked_at_across(edges, axes):
    gas = pyvista.RectilinearGrid(*(np.linspace(0.0, length, 5) for length in edges))
    gas.cell_data["temperature"] = gas.cell_centers().points[:, edges.index(min(edges))]
    own = taken(pyvista.PolyData(), gas)
    assert own.axes == axes
    if axes:
        grid = raster.pixels(own, 40)
        assert np.ptp(raster.gas(own, grid, "temperature", smooth=False)) == 0.0


def test_the_box_is_of_gas_and_walls_else_of_the_particles():
    places = lattice(3)
    assert taken(cloud(places), cells()).box == pytest.approx([0.0, 1.0, 0.0, 2.0, 0.0, 0.0])
    assert taken(cloud(places)).box == pytest.approx([0.042, 0.258, 0.042, 0.258, 0.0, 0.0])


@pytest.mark.parametrize(
    ("scene", "arrays", "subject"),
    [
        ("bubbling_bed", {"alpha_p": 0.6, "temperature": 288.0, "velocity": 0.0}, "alpha_p"),
        ("bubbling_bed", {"alpha_p": 0.6, "temperature": [288.0, 350.0], "velocity": 0.0}, "alpha_p"),
        ("disc_cluster", {"alpha_p": 0.5, "temperature": [300.0, 350.0], "velocity": 1.0}, "temperature"),
        ("fluidised_column", {"alpha_p": 0.5, "temperature": [300.0, 303.0], "velocity": 1.0}, "alpha_p"),
        ("granular_jet", {"theta": 0.2, "temperature": 288.0, "velocity": 1.0}, "theta"),
        ("evaporating_jet", {"temperature": [290.0, 350.0], "velocity": 1.0}, "temperature"),
        ("dam_break", {"pressure": 10.0, "velocity": 1.0}, "velocity"),
        ("hydrostatic_tank", {"pressure": 10.0, "velocity": 1e-4}, "pressure"),
        ("taylor_bar", {"plastic_strain": [0.0, 0.2], "equivalent_stress": 1e8, "velocity": 1.0}, "plastic_strain"),
        ("colliding_rings", {"equivalent_stress": [0.0, 1e8], "velocity": 1.0}, "equivalent_stress"),
        ("gel_spray", {"temperature": 300.0, "velocity": 1.0}, "velocity"),
    ],
)  # fmt: skip
def test_a_picture_is_of_what_its_scene_is_about(scene, arrays, subject):
    full = {name: np.resize(values, 9).astype(float) for name, values in arrays.items()}
    full["velocity"] = np.column_stack((full["velocity"], np.zeros((9, 2))))
    own = replace(taken(cloud(lattice(3), **full)), case=cases.load(scenes.HERE / scene / "case.toml"))
    assert shot.chosen([own], None) == subject
    assert shot.chosen([own], "density") == "density" and shot.chosen([own], "speed") == "velocity"
    with pytest.raises(CaseError, match="--field colour: this run has .*density"):
        shot.chosen([own], "colour")


def test_up_is_against_gravity():
    assert shot.upwards((0.0, -9.81, 0.0)) == (0.0, 1.0, 0.0)
    others = ((0.0, 0.0, -0.5), (0.8, 0.0, 0.0), (0.0, -9.81))
    assert all(shot.upwards(gravity) == (0.0, 0.0, 1.0) for gravity in others)


@pytest.mark.parametrize("box", [(0.0, 3.0, 0.0, 1.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0, 0.0, 4.0)])
def test_the_whole_box_is_seen_with_up_up(box):
    own = replace(taken(cloud(lattice(3))), box=np.array(box), up=(0.0, 0.0, 1.0))
    seen = eye.on(own)
    places = seen.seen(eye.corners(own.box))
    assert (places >= seen.low - 1e-12).all() and (places <= seen.high + 1e-12).all()
    assert seen.up @ (0.0, 0.0, 1.0) > 0.8 and seen.right @ (1.0, 0.0, 0.0) > 0.5


def test_the_domain_fills_the_figure_and_nothing_hides_it():
    """Of a domain of any shape the picture's longer side is the same, and title, numbers and bar have their room."""
    for wide, high in ((6.0, 4.0), (0.5, 1.0), (10.0, 1.0), (0.03, 0.45)):
        sheet = canvas.Sheet(wide, high, style.THEMES["light"])
        assert max(sheet.own) == pytest.approx(canvas.LONGEST)
        assert sheet.own[0] / sheet.own[1] == pytest.approx(wide / high)
        assert (sheet.corner + sheet.own < sheet.size).all()
        assert (np.round(sheet.size * canvas.DPI) % 2 == 0).all()


@pytest.mark.parametrize("more", [{}, {"theme": "dark", "smooth": True, "outline": True, "vectors": True}])
def test_pictures_with_all_that_was_asked_for(more, tmp_path):
    moving = np.column_stack((np.ones(81), np.linspace(0.0, 1.0, 81), np.zeros(81)))
    gas = cells("alpha_p", lambda x: np.exp(-8.0 * ((x[:, 0] - 0.5) ** 2 + (x[:, 1] - 1.0) ** 2)))
    gas.cell_data["velocity"] = np.tile([0.0, 2.0, 0.0], (gas.n_cells, 1))
    own = taken(cloud(lattice(9), velocity=moving), gas)
    drawn = view.sheet(own, Look("velocity", **more))
    for suffix in view.KINDS:
        view.save(drawn, tmp_path / f"a{suffix}")
        assert (tmp_path / f"a{suffix}").stat().st_size > 5000
    assert drawn.image()[0, 0] == pytest.approx(np.round(255 * rgb(style.THEMES[more.get("theme", "light")].paper)))
    arrows = [part for part in drawn.axes.collections if type(part).__name__ == "Quiver"]
    assert len(arrows) == bool(more)
    assert len(drawn.axes.collections) - len(arrows) == (3 if more else 1)  # edge of the particles, outline twice


def test_an_outline_is_where_a_bubble_ends():
    gas = cells("alpha_p", lambda x: 0.6 * (x[:, 1] > 1.0))
    own = taken(pyvista.PolyData(), gas)
    drawn = flat.draw(own, Look(outline=True), {"alpha_p": style.scale("alpha_p", own.values("alpha_p"))}, 1.0)
    height = np.concatenate([path.vertices[:, 1] for path in drawn.axes.collections[-1].get_paths()])
    assert height == pytest.approx(1.0 - 0.25 * (0.5 - 0.15 / 0.6) * 2 / 2, abs=0.07)


def test_an_outline_is_drawn_on_the_cut_in_space():
    gas = pyvista.RectilinearGrid(*[np.linspace(0.0, 1.0, 5)] * 3)
    gas.cell_data["alpha_p"] = 0.6 * (gas.cell_centers().points[:, 2] < 0.5)
    own = taken(pyvista.PolyData(), gas)
    counts = []
    for outline in (False, True):
        look = Look(outline=outline)
        plotter = space.plotter((50, 50), look)
        space.fill(plotter, own, look, style.scale("alpha_p", own.values("alpha_p")), "alpha_p", eye.on(own))
        counts.append(len(plotter.actors))
        plotter.close()
    assert counts[1] == counts[0] + 1


def test_a_picture_of_another_kind_is_refused(tmp_path):
    with pytest.raises(CaseError, match=r"a.jpg: its name must end with .png or .svg or .pdf"):
        view.show(tmp_path, tmp_path / "a.jpg")


def test_the_window_follows_time_and_field(tmp_path):
    from sdph.running.fields import Fields

    fields = Fields(tmp_path)
    (tmp_path / "fields").mkdir()
    for time in (0.0, 1.0):
        fields.write(time, {"particles": cloud(lattice(4, 3), ident=np.arange(64), pressure=np.full(64, 5.0 + time))})
    stage = window.Stage(tmp_path, None, Look("pressure"))
    stage.set_up(space.plotter((200, 150), stage.look))
    whole = stage.plotter.screenshot(return_img=True)
    stage.show(number=0)
    assert (stage.shot.time, stage.field) == (0.0, "pressure")
    stage.next_field()
    assert stage.field == "velocity"
    stage.clip = (0, 0.5)
    stage.show()
    assert window._clipped(stage.shot, stage.clip).particles.n_points == 32
    assert np.abs(stage.plotter.screenshot(return_img=True).astype(float) - whole).max() > 50.0
    stage.plotter.close()


def test_numbers_that_stand_for_words_are_told_by_them():
    sheet = canvas.Sheet(1.0, 1.0, style.THEMES["light"])
    sheet.bar(style.Scale("material", "viridis", 0.0, 2.0, 0.0, 1.0, "neither"), ("sand", "char", "ash"))
    bar = sheet.figure.axes[-1]
    assert [label.get_text() for label in bar.get_yticklabels()] == ["sand", "char", "ash"]
    assert np.array_equal(bar.get_yticks(), [0.0, 1.0, 2.0]) and bar.get_ylim() == (-0.5, 2.5)
