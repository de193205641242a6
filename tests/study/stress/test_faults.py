"""The short form of `sdph stress --faults`: a few kills, and each other fault once."""

from sdph.study.stress import faults


def test_faults_are_named_leave_nothing_and_are_made_good():
    checks = faults.run(3)
    assert len(checks) == 9
    assert all(check["ok"] for check in checks), [check for check in checks if not check["ok"]]
