"""Programs as text for others, all from the one tape: a dialect is a table of operators and a few patterns.

dialects.py  statements of a tape in a dialect: patterns, operators (dialects.csv)   language_c.py   a block as C
files.py     whole files in every language
"""
