from .verdict import Verification
def explained(v): return v
