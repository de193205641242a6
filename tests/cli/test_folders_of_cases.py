"""Folders that are given as cases and are none."""

import pytest
from test_cli import refused  # noqa: F401


@pytest.mark.parametrize("command", ["run", "explain"])
def test_a_folder_without_a_case_file_is_told_to_be_one(refused, tmp_path, command):  # noqa: F811
    """One that is called as a scene is in its way."""
    for name in ("empty", "disc_cluster"):
        (tmp_path / name).mkdir()
    line = refused(command, "empty")
    assert "empty is a folder that holds no case.toml" in line and "sdph init" in line and "gel_spray" not in line
    assert "for the scene disc_cluster rename that folder" in refused(command, "disc_cluster")
