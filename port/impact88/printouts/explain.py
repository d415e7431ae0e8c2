"""What explains a page that differs."""

from .findings import Verification


def explained(verification: Verification) -> Verification:
    """Return a verification with what explains it."""
    return verification
