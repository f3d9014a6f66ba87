"""Spring laws of the elastic hinge: force, stored energy and its inverse against the closing z.

         |<------ H ------>|
         |<- z ->|<- H-z ->|           z = 0: the spring has its free height H
    =====|-------|#########|=====      z > 0: it is shorter, F pushes the rollers outwards

A law is a record of numbers that answers what `Spring` asks, in a file of its own, and a row in `mechsym.cases.schema`:
`air_gauge` (the paper's, which takes the excess pressure for the whole pressure) and `air_absolute` (a real gas spring
with the atmosphere outside) in `air`, `coil`, and `air_thermal`, whose gas has a temperature besides.
"""
