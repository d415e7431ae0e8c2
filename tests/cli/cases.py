"""Collisions that several tests ask about."""

CRASH = """\
units = "us"
case = "24-117"
MA = 3091
MB = 4669
IA = "estimate"
IB = "estimate"
DA = 4.5
DB = 4
GA = 0
PA = 0
PB = -40
TA = 0
TB = 90
UX = "-25 +- 2"
UY = 0
WA = 0
VX = 0
VY = "40 +- 2"
WB = 0
E = "0.1 .. 0.3"
MU = 0.5
EM = 1
"""
REAR_END = """\
units = "us"
M = 4
MA = "950 kg"
MB = "770 kg"
SA = 5.5
HA = 0
SB = 0
E = 0.2
TA = "course"
TB = "course"
"""
MEASURED_SPEED = 'SA = "5.5 +- .2"\nSA_source = "event data recorder"'
RECORDER = REAR_END.replace("SA = 5.5", MEASURED_SPEED)
RECORDER = RECORDER.replace("E = 0.2", 'DVA = "3.1 +- .3"\nDVB = "3.5 +- .3"')
INTERSECTION = """\
units = "metric"
M = 4
MA = 1800
MB = 1200
HA = 0
HB = -90
SAF = 50
HAF = -40
SBF = 30
HBF = -30
TA = "course"
TB = "course"
"""
IMPOSSIBLE = REAR_END.replace("E = 0.2", "SBF = 30\nHBF = 0")
FILES = {
    "crash.toml": CRASH,
    "rear.toml": REAR_END,
    "recorder.toml": RECORDER,
    "intersection.toml": INTERSECTION,
    "impossible.toml": IMPOSSIBLE,
    "cases.csv": "case,MU,E\nfirst,.5,.1\nsecond,much,.2\nthird,.7,.3\n",
    "replies.txt": "-29.04,0,0\n14.52,25.15,0\n",
    "hello.bas": '10 INPUT N$\n20 PRINT "HELLO, "N$\n',
    "broken.bas": "10 PRINT 1/0\n",
}
