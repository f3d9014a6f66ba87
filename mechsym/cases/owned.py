"""Names of what belongs to a link or a joint: `rod.mass` and `rod.angle`, `C.x` and `C.R_x`, beside rod_mass, x_C.

The name with underscores is the letter of the code, of files and of JSON; the one with a dot is read wherever a user
names one, so that nobody has to know which of both parts comes first.
"""

from collections.abc import Container

_WORDS = {"angle": ("theta_{}", "angle_{}"), "place": ("s_{}",)}


def letter_of(name: str, known: Container[str]) -> str:
    """The letter that a name with a dot means, or the name as it is.

    >>> letter_of("rod.mass", {"rod_mass"}), letter_of("C.x", {"x_C"}), letter_of("rod.angle", {"theta_rod"})
    ('rod_mass', 'x_C', 'theta_rod')
    """
    owner, dot, what = name.rpartition(".")
    if not dot or name in known:
        return name
    forms = (f"{owner}_{what}", f"{what}_{owner}", *(form.format(owner) for form in _WORDS.get(what, ())))
    return next((form for form in forms if form in known), name)
