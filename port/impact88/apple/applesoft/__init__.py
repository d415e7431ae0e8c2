"""A machine that computes and talks as Applesoft II does; it knows nothing of collisions."""
