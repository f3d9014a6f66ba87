"""What mechsym's emitted code costs against hand-written C and against the named alternatives, in one run.

    python -m benchmarks              everything, with table, JSON and chart (make bench)
    python -m benchmarks P2 P5        some problems

Every problem is a module with `rows(...)`: it builds all routes, checks that they give the same numbers, and only then
takes times, in turn, so that a disturbance of the machine falls on all of them.
"""
