"""The hypocycloid engine as a whole: engine, its masses and forces; checks and design."""
