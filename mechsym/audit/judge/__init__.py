"""Is the formula the quantity? States, proofs, powers of lambda, dimensions, and what is taken for granted."""
