"""Faults planted one at a time in a copy of the tree, and whether the tests that should see them do: python -m
tests.faults."""
