"""The errors that a user can mend. The command line turns them into one line and exit status 2."""


class BadInput(ValueError):
    """Input that cannot be used.

    The message is one line: what was found (file, key, value, unit), what is allowed, and the way out.
    """


class MissingExtra(BadInput):
    """A command needs an optional package; the message names the extra that brings it."""
