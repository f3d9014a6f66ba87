"""Machine-made inputs against the command line, and mutants of modules against their tests."""
