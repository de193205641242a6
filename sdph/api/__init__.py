"""Python's door to sdph: what `import sdph` offers, on the same functions as the command line.

case        `Case`: load, change by keys with units, validate, save
running     `run`, `resume`, `stepping`: a run to its end, further, or window by window
results     `load`, `Run`: summary, tables as pandas frames, fields as pyvista meshes or arrays
explaining  `explain`: what a case calls for, before it runs
tank        `Tank`: a liquid in the loop of a spacecraft
launch      what `run` and `sdph run` do before a run begins

Bad input is a `CaseError` with the same line that the command line prints.
"""
