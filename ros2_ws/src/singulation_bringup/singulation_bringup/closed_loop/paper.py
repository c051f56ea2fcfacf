"""Table III of the paper (section VII): mean ratio (s' - s) / s over its physical experiments."""

from types import MappingProxyType

# (policy, contact mode) -> easy, hard, average
TABLE_III = MappingProxyType(
    {
        ("cluster_push", "single_point"): (0.366, 0.194, 0.290),
        ("cluster_diffusion", "single_point"): (0.308, 0.149, 0.235),
        ("cluster_push", "edge"): (0.411, 0.227, 0.344),
        ("cluster_diffusion", "edge"): (0.377, 0.188, 0.277),
        ("cluster_push", "two_point"): (0.445, 0.245, 0.358),
        ("cluster_diffusion", "two_point"): (0.463, 0.169, 0.316),
    }
)
# "ClusterPush outperforms Cluster Diffusion by": the quotient of the two single-point rows, less one.
AHEAD = (0.188, 0.300, 0.236)
# "Edge pushing and two-point pushing improve push performance by": both policies together, on average.
IMPROVEMENT = MappingProxyType({"edge": 0.184, "two_point": 0.284})
