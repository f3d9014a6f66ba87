"""The one palette: every colour on light paper with its partner on dark paper; contrast 4.5 for what is read."""

PAPER, INK = "#ffffff", "#1b2a41"
BLUE, RED, GREEN, ORANGE, VIOLET = "#1f5fa8", "#b5342b", "#2a744a", "#866a00", "#7a4fa3"
TEAL, PINK, GREY, QUIET = "#0f727d", "#ab2f7a", "#667080", "#5b6675"  # grey and quiet: lines and text that explain
GRID = "#e3e6ea"
SERIES = (BLUE, RED, GREEN, ORANGE, VIOLET, TEAL, PINK, INK)  # curves of one kind, in this order

# what parts are filled with
PISTON, CYLINDER, CRANK, GEAR, BEARING = "#a9c7e3", "#cdd3dc", "#d3c0a0", "#e2c46c", "#b2c3a6"
CARRIER, SHAFT, WHEEL, GAS, ROLLER, NOTHING = "#e6dff0", "#bfb0d6", "#f1f3f6", "#d5e6f7", "#f3dcb8", "#eef0f3"
_FILLED = {
    PISTON: "#35597c", CYLINDER: "#46505d", CRANK: "#66563a", GEAR: "#7a6420", BEARING: "#4c5d41", CARRIER: "#4a4260",
    SHAFT: "#5d4f78", WHEEL: "#222a33", GAS: "#233c56", ROLLER: "#6b5020", NOTHING: "#1d242c",
}  # fmt: skip
#: What a colour becomes on dark paper
DARK = {
    PAPER: "#14191f", INK: "#e6eaf0", BLUE: "#7db4f0", RED: "#f2877d", GREEN: "#6cc590", ORANGE: "#e3b341",
    VIOLET: "#c3a0e8", TEAL: "#5cc6d0", PINK: "#ee8fc4", GREY: "#9aa5b3", QUIET: "#a9b3c0", GRID: "#2b333d", **_FILLED,
}  # fmt: skip
