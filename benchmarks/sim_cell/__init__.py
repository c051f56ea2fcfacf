"""What the simulated cell costs, and that it does not grow."""
