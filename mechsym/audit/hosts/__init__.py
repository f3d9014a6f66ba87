"""Where formulas come from, and where the answers go: the user, papers, programs, sources, pages."""
