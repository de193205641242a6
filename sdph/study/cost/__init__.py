"""`sdph cost`: what accuracy costs in time.

ladder         the settings that a scene is measured with, from coarse to fine
climb          wall time and metrics of each, and of other solvers on the same scene
rows           what was measured: observed orders, changes, the cheapest that holds an error
measured_case  which case of one's own it was measured of
converged      the limit of a ladder, and the doubt about it
errors         what each row errs by against that limit, and what may be promised of it
choice         `sdph run --accuracy`
report         tables and the work-precision diagram
summary        the table of all scenes
"""
