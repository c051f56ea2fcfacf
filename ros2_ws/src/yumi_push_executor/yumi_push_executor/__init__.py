"""From a push to a supervised closed-jaw, jaw-side or open-jaw motion of an ABB YuMi."""
