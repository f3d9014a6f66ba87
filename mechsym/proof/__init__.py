"""Numbers that come with a theorem, in balls of python-flint (the extra `proof`), imported where they are used.

balls       midpoints with radii, and a tape over them
rounding    what doubles can lose in a generated function: running error analysis on its tape
sampled     what the compiled code returns, against 60 digits
outputs     both side by side, output by output
enclosure   Taylor coefficients of a motion from the tape, steps from a set of states to the next
work        integrals of a law over the angle: the bound of a co-design in balls
motion      a motion from its start to a time: equations, digits that it needs, what is kept on the way
"""
