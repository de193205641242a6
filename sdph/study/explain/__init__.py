"""`sdph explain`: what a case calls for, what limits its steps, and what it will cost, before it runs.

estimate       limits, memory and time
prices         time of a particle, a cell, a window, as measured
pace           windows and sub-steps
feed           heat of what nozzles feed
lockstep       steps of a liquid with bodies in it
droplets       numbers of droplets
liquids        those of a liquid
solids         those of solids
haze           whether grains hide each other as they radiate
mach           how fast gas is by its sound
pressed        whether grains begin denser than their weight holds them
vessel         volume of a tank, and of what fills it
gel            growth and tear of a gel droplet
stages         effects of a gel droplet that grows, necks and has torn
tables         all of it as tables
effect_costs   time of each effect on this machine
"""
