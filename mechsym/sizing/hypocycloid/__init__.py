"""hypocycloid."""
