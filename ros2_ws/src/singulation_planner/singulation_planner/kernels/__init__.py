"""Compiled inner loops.

Each module stands alone: numba's cache notices changes of the file a function is in, not of the files it calls into.
"""
