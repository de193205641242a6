"""`sdph explain`: what a case calls for, what limits its steps, and what it will cost, before it runs.

estimate       limits, memory and time
pace           windows and sub-steps
droplets       numbers of droplets
liquids        those of a liquid
solids         those of solids
tables         all of it as tables
effect_costs   time of each effect on this machine
"""
