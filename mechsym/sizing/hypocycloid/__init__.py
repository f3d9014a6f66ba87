"""The hypocycloid engine as a whole: engine, masses and forces, checks, design."""
