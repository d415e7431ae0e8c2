"""Tables of scenes: read (`engine`), solved row by row (`solving`), swept (`sweeping`), written."""
