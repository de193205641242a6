"""Windows of a bed with heat in which all begins at one temperature: drag warms it by some mK."""

from sdph import scenes
from sdph.case import read as cases
from sdph.running import driver
from sdph.running.progress import Reporter

COARSE = ("resolution.spacing_mm=20", "resolution.cell_mm=20", "coupling.gas='embedded'", "run.end_time_s=2e-3",
          "run.output_interval_s=2e-3", "boundaries.jet.temperature_K=288.0", "track.particles=[]")  # fmt: skip


def test_a_bed_of_one_temperature_gets_on(tmp_path):
    """On average windows of more than 20 us; they would be shorter than 1 us if they resolved what drag makes."""
    case = cases.load(scenes.find("bubbling_bed")[1], COARSE)
    assert max(case.temperatures) == min(case.temperatures)
    found = driver.run(case, "bubbling_bed", tmp_path / "run", None, Reporter(quiet=True))
    print(f"{found['windows']} windows")
    assert found["windows"] < 100
