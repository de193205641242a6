"""The gallery: every scene has an entry that can be run, and its pictures are small."""

import tomllib

import numpy as np
import pytest
from PIL import Image
from scripts import FOLDER, script

from sdph import scenes
from sdph.case import read as cases
from sdph.cli.arguments import parser

ENTRIES = tomllib.loads((FOLDER / "gallery.toml").read_text())


@pytest.fixture(scope="module")
def gallery():
    return script("gallery")


def test_every_scene_has_a_picture():
    assert list(ENTRIES) == scenes.names()


@pytest.mark.parametrize("scene", ENTRIES)
def test_its_run_and_its_view_can_be_asked_for(scene, gallery):
    entry = ENTRIES[scene]
    options = parser().parse_args(["run", scene, *gallery.settings(entry)])
    case = cases.load(scenes.HERE / scene / "case.toml", tuple(options.set))
    assert ("grains" in case.matters) == ("gas" in entry)
    assert case.run.output_interval <= case.run.end_time
    assert parser().parse_args(["view", "run", "--png", "a.png", *entry.get("view", [])]).png


def test_large_pictures_are_made_smaller(gallery, tmp_path):
    noise = np.random.default_rng(1).integers(0, 255, (500, 500, 3), np.uint8)
    Image.fromarray(noise).save(tmp_path / "a.png")
    before = (tmp_path / "a.png").stat().st_size
    gallery.shrink(tmp_path / "a.png")
    assert (tmp_path / "a.png").stat().st_size < 0.5 * before
    assert Image.open(tmp_path / "a.png").size == (500, 500)
