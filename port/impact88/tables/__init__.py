"""Tables of scenes: CSV and JSON Lines by the standard library, Parquet and Excel by polars."""
