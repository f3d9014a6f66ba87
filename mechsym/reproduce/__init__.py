"""Published numbers and figures beside what the models give, one module per source: `rows()`, and `figures()` for those
whose pictures can be drawn again."""
