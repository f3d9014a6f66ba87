"""Claims that the sources make in words, each with the computation that decides it, and the effect of misprints."""
