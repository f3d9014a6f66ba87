"""What printed formulas are compared with: letters with units and a tape of derived, named expressions."""
