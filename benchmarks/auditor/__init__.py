"""Trials of the auditor by what it was not tuned to: a spoiler with an evaluator of its own, and traps."""
