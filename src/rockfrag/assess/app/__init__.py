"""The whole assessment as one page, ``rockfrag app``."""
