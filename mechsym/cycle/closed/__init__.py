"""The closed period of an engine cycle, from numbers or CasADi symbols.

model       an engine as one record, with some of its values replaced; its gas exchange by blowdown
equations   the first law in the crank angle
run         its integration, phase by phase, at many operating points side by side
performance torque, power, consumption, energy shares; all of it as one function with derivatives
"""
