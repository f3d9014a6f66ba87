"""The engine cycle in the loop: gas states and the mechanism's motion integrated together, cylinder by cylinder."""
