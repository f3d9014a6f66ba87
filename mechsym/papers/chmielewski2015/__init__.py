"""chmielewski2015."""
