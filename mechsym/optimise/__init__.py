"""Design of an engine by optimisation: a problem from a case, solved with IPOPT, its limits explained."""
