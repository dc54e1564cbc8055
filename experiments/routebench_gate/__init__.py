"""Says whether new results are worse than old ones; behind `routebench gate`."""
