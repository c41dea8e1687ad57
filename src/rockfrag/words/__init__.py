"""Words of answers: findings without words, and catalogues that say them, one file a language.

A finding holds the id of a text and the values that stand in it; every decision that leads to it was taken in
Python. A text is a whole sentence with ``{places}``, or one for each plural form; it knows no branches. The page
formats the same findings by the same files (``catalogue.js``).
"""
