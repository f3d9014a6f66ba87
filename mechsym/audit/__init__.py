"""The auditor: published hand formulas compared with the derivations, misprints found and repaired by search.

One road from a printed formula to its row, and a drawer for each stretch of it; a drawer imports from those above it.

read/      text to tree and back: Python, LaTeX, what programs write (reader.py); a tree in floats, digits, symbols;
           all equations of a text with its nomenclature (said.py), all claims of a program (programs/claims.py)
theory/    the derived quantities that formulas are compared with; theories/ are those that are data
judge/     states at which formula and quantity are compared (question.py), exact? (prover.py), powers of lambda
           (orders.py), dimensions, left sides, assumptions, conventions, Coq scripts; of a whole text its
           units (kinds.py), its own definitions (world.py) and the theories that fit (fit.py); of a program what its
           names mean in a theory (lexicon.py, fitted.py) and to what they come near (nearness.py)
repair/    what each part would have to be (required.py), slips, what was left out, two at once; search.py says in
           which order
verdict.py the decision
hosts/     where formulas come from: the user (formula.py), papers by a theory (paper.py) or by themselves (whole.py),
           a function (program.py), a repository (repository.py, neighbours.py, slips.py, findings.py; itself.py and
           described.py without a theory), sources (sources.py) with errata

How far it can be trusted is tried in benchmarks/auditor.
"""

from mechsym.audit.hosts.formula import check_file, check_formula

__all__ = ["check_file", "check_formula"]
