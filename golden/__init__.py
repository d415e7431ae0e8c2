"""What must never change: captures of the real ROM, golden printouts, reference digits."""
