"""The auditor: published hand formulas compared with the derivations, misprints found and repaired by search."""
