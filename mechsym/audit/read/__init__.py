"""Text to tree and back, and what a tree is worth in floats, in many digits and in symbols."""
