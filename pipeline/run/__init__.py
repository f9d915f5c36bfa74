"""The driver: what is stale, in parallel, published whole or not at all."""
