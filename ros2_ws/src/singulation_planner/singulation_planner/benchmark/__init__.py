"""Policies against each other over many scenarios: generators, runs, the paper's tables."""
