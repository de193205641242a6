"""`sdph cost`: what accuracy costs in time.

ladder    the settings that a scene is measured with, from coarse to fine
climb     wall time and metrics of each, and of other solvers on the same scene
rows      what was measured: errors, observed orders, the cheapest that holds an error
choice    `sdph run --accuracy`
report    tables and the work-precision diagram
"""
