"""A collision: its values by name, as texts, numbers and ranges, with their units and estimates."""
