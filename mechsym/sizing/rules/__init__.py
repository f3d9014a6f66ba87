"""One rule a function, with its source, its range and a worked example."""
