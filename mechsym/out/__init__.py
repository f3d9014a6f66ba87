"""Out of the tool: what other programs and workshops read.

block.py   a machine with its ports, from a problem      fmi/   functional mock-up units
text/      C, Modelica, Julia, MATLAB, JAX               web/   a page that simulates
cad/       drawings of the guide                         pdf.py  a page printed
"""
