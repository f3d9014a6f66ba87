"""Published numbers and figures beside what the models give, one module per source."""
