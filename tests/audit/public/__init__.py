"""Truths of the public bench, of their own: nothing of mechsym is imported here."""
