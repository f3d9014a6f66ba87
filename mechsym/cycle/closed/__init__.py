"""The closed period of an engine cycle, from numbers or CasADi symbols.

model       an engine as one record, with some of its values replaced
equations   the first law in the crank angle      phases, runge_kutta   its integration, phase by phase
run         many operating points side by side    performance           torque, power, consumption, energy shares
differentiable   all of it as one function with derivatives
"""
