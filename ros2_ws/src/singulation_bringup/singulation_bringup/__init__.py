"""Brings the suite up: coordinator, launch files, parameter files, displays."""
