"""`sdph cost`: what accuracy costs in time.

ladder   settings from coarse to fine, measured: wall time and error
report   tables and the diagram of what was measured
"""
