"""Unknowns and tolerances: from what is known of an impact to the rest of it."""
