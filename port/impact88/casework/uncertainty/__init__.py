"""Values known within limits: bounds, draws, and what drives which result."""
