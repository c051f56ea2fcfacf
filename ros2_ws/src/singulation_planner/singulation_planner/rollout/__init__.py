"""Planning by simulation: candidates scored by geometry, the best simulated, the best of those refined."""
