"""hinge."""
