"""Recomputes what a session file claims, from the file alone and from the paper's equations.

Written independently of the program on purpose: nothing here shares code or formulas' shape with
it, so that an agreement means something.
"""
