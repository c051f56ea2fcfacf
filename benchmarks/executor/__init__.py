"""Benchmarks of the executor's motion planning."""
