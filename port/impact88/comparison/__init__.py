"""Another program's results compared with the reference, and mistakes that explain them."""
