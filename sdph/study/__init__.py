"""Studies of cases and runs: explain, cost, stress, compare, validate, report."""
