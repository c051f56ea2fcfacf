"""Node mechanics that every node of the suite shares: guarded callbacks, parameters, lifecycle, diagnostics."""
