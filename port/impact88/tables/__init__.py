"""Tables of scenes: CSV, JSON Lines and .npz, read and written a block of rows at a time."""
