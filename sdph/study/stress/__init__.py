"""`sdph stress`: hard cases that have to stay stable.

suite        cases, one file each under validation/stress, run and judged
measures     what they are judged by
boundaries   how far beyond its limits each effect stays stable
faults       runs that are killed, starved or disturbed
processes    what of a run still goes on
"""
