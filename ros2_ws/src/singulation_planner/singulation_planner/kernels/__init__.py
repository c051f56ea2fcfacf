"""Compiled inner loops.

What several modules use has a module of its own. Numba's cache notices changes of the file a function is in, not of the
files it calls into; ``scripts/setup`` compiles all anew when any of them changed.
"""
