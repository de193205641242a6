"""Folders of the runs of a sweep: called by what varies, and each of another case."""

from sdph.effects.around import frame
from sdph.study.sweep import jobs


def test_a_long_value_leaves_the_others_their_place_in_a_folders_name(tmp_path):
    point = {"title": "x" * 80, "gas.temperature_K": "301"}
    (made,) = jobs.jobs_of("disc_cluster", [point], (), (), tmp_path, 0)
    assert "temperature_K=301" in made.name


def test_a_file_that_has_changed_makes_another_run(tmp_path):
    """Not its name alone is what a run is of."""
    motion = tmp_path / "motion.csv"
    folders = []
    for amplitude in (1, 1, 2):
        motion.write_text(f"{','.join(frame.COLUMNS)}\n0,{amplitude},0,0,0,0,0\n1,0,0,0,0,0,0\n")
        sets = (f'frame.table="{motion}"', "frame.shake=[]")
        (made,) = jobs.jobs_of("sloshing_box", [{"run.end_time_s": "0.1"}], sets, (), tmp_path, 0)
        assert not made.refused
        folders.append(made.folder)
    assert folders[0] == folders[1] != folders[2]
