"""`sdph sweep`: many runs of one case, over values of its keys.

plan    points: a grid of values, or rows of a CSV file
jobs    a run of a point: its folder, whether it is still to be done, how it ended
pool    who does them: this process one by one, or workers of dask
table   sweep.csv, and its figure
sweep   all of it
"""
