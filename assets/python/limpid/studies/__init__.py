"""Studies that are run as they are, and are examples of how one is written."""
