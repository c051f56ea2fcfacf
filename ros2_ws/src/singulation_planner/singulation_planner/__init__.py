"""Push policies: ClusterPush, the other policies of the paper, and our own."""
