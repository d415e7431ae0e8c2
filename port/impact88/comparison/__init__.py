"""Reference results of scenes, and other programs' results compared with them."""
