"""The auditor: published hand formulas compared with the derivations, misprints found and repaired by search.

reader.py, latex.py, printer.py   text to tree and back (tree.py, limits.py, spelling.py)
algebra.py                        one tree in floats, in many digits and in symbols
theory/                           the derived quantities that formulas are compared with
question.py                       states at which formula and quantity are compared
prover.py                         exact? digits decide, polynomials prove
certificate.py, certified.py      proofs as Coq scripts
orders.py, dimensions.py          how good an approximation is; does it rescale
edits.py, required.py,            single edits; what each part would have to be; what was left out;
insertion.py, candidates.py       edits that meet it
repair.py, verdict.py             the search and the decision
entries.py                        what a paper holds: formulas as printed, and the claims of its text (`papers/`)
findings.py, errata.py            rows, and docs/errata.md
formula.py                        the user's own formula
code.py, code_rows.py             formulas of programs
displayed.py, symbols.py,         the display equations of a paper in LaTeX; a page of what was found
paper_rows.py, page.py
trial/                            tests of the auditor itself
"""

from mechsym.audit.formula import check_file, check_formula

__all__ = ["check_file", "check_formula"]
