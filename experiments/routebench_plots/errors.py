"""The one exception type of this package."""


class PlotError(Exception):
    """Input that cannot be used.

    The message is one line: file or option, what is wrong with it, and
    what would be right.
    """
