"""Which slip makes the formula right? Single edits, what was left out, two slips at once."""
