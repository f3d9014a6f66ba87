"""Every relation of the sources as printed, one module per source (two for the thesis)."""
