"""What may be known of an impact."""

from ..names import FINAL_VELOCITIES, SCENE

PLAIN = (*SCENE, "MUP", *FINAL_VELOCITIES)
"""What `unknowns.solve_for` knows; the other names need the adjustment."""
OTHERS = (
    *("SA", "HA", "SB", "HB", "SAF", "HAF", "SBF", "HBF"),
    *("DVA", "DVB", "DVAF", "DVAR", "DVBF", "DVBR", "KI", "KF", "EL", "LOSS", "DT"),
    *("ELA", "ELB", "VC", "VS", "PDOFA", "PDOFB"),
)
KNOWABLE = (*PLAIN, *OTHERS)
