"""prymak."""
