"""Published numbers and figures beside what the models give, one module per source.

record.py       a row: published, computed, verdict, note
sources.py      the five sources by name, their rows and their figures
findings.py     what the last recorded run found, and how a new run differs
page.py         CSV, HTML and pictures of a run
<source>.py, <source>_figures.py   rows and figures of one source
"""
