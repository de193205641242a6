"""`sdph explain`: what a case calls for, what limits its steps, and what it will cost, before it runs.

scales         orders of magnitude of a case
judge          which effects they call for
estimate       limits, steps, memory and time
ways           how far grains and gas get
droplets       numbers of droplets
tables         all of it as tables
effect_costs   time of each effect on this machine
"""
