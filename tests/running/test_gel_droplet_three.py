"""Three bubbles in a shell: the scene in two layers of shell, heated four times as fast, up to 0.02 s."""

from sdph import scenes
from sdph.case import read as cases
from sdph.running.hastened import of

COARSE = (
    "resolution.spacing_mm=0.025", "liquid_heat.flux_W_m2=5.68e5", "run.end_time_s=0.02", "run.output_interval_s=0.01",
    "liquid.history_interval_s=0.002",
)  # fmt: skip


def test_three_bubbles_grow_side_by_side_and_close_mass_heat_and_momentum(tmp_path):
    run = of(cases.load(scenes.HERE / "gel_droplet_three" / "case.toml", COARSE), tmp_path / "ledger.csv")
    first = run.row()
    run.start()
    while not run.clock.over(run.time):
        run.window()
    row, told = run.row(), run.summary(None) | run.ledger.summary()
    assert told["bubbles_left"] == 3 and told["bubbles_merged"] == told["bubbles_closed"] == 0
    for number in (1, 2, 3):
        assert row[f"bubble_{number}_diameter_m"] > first[f"bubble_{number}_diameter_m"]
        assert (
            abs(row[f"bubble_{number}_pressure_Pa"] - row["bubble_pressure_Pa"]) < 1000.0
        )  # Pa; 100 in gel-droplet.md
    assert row["diameter_ratio"] > 1.001
    assert max(told[name] for name in ("mass_drift_rel", "heat_drift_rel", "momentum_drift_rel")) < 1e-12
