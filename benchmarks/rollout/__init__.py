"""Benchmark of the policy rollout_push."""
