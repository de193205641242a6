"""What is asked of cases and runs: explain, cost, stress, compare, validate, report."""
