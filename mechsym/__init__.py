"""mechsym: exact equations of motion, verified machine code, elastic hinges and guides."""
