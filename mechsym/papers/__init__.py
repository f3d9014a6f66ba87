"""Published numbers and figures beside what the models give.

rows.py         a row: published, computed, verdict, note
sources.py      the five sources by name, their rows and their figures
page.py         CSV, HTML and pictures of a run
findings.json   the recorded verdicts; a finding is a result, only a changed one is a failure (`mechsym.recorded`)
<source>.py     what is computed for a source; <source>_rows.py, <source>_figures.py set it beside the print
"""
