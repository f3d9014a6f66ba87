"""Runtime mechanisms: frozen parameters and `build(params) -> Mechanism` on top of the generated code."""
