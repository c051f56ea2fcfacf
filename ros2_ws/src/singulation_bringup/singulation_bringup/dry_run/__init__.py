"""Motions that are planned and shown, never ordered."""
