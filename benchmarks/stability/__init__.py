"""Where each estimator holds, says that it does not, refuses, or is silently wrong."""
