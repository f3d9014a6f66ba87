"""torsion."""
