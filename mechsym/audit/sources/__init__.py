"""Every relation of the sources as printed, one module per source (several for the thesis)."""
