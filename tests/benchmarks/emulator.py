"""How fast the emulator runs the listing, beside the port, scene by scene, in one run.

    python tests/benchmarks/emulator.py [--pcbasic PYTHON]

Both run the same scenes in turns, in process; the ratio is the median of the scenes' ratios. Typing
a scene's lines into the emulator is counted apart: it is done once, the run as often as wanted.
Loops that do one thing follow. With --pcbasic the same listing, its INPUT lines replaced by
assignments, runs as a process under PC-BASIC (``pip install pcbasic``), beside ``impact88 basic``
on the very same file.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import captures

from impact88.apple.emulator.emulator import Applesoft
from impact88.files import packaged_text
from impact88.program import emulated
from impact88.program.run import run
from impact88.program.scene import Scene, sample

SCENES = 100
ROUNDS = 5


def in_process() -> None:
    """Port and emulator on the captured scenes."""
    scenes = [Scene(case["scene"]) for case in captures.scenes()[:SCENES]]
    run(scenes[0], dos=False)
    emulated.run(scenes[0], dos=False)
    port: list[list[float]] = [[] for _ in scenes]
    emulator: list[list[float]] = [[] for _ in scenes]
    typing: list[float] = []
    for _ in range(ROUNDS):
        for n, scene in enumerate(scenes):
            start = time.process_time()
            run(scene, dos=False)
            middle = time.process_time()
            machine = emulated.load_machine(scene, dos=False)
            typed = time.process_time()
            emulated.run_machine(machine)
            port[n].append((middle - start) * 1e3)
            typing.append((typed - middle) * 1e3)
            emulator[n].append((time.process_time() - typed) * 1e3)
    ours = [statistics.median(times) for times in emulator]
    theirs = [statistics.median(times) for times in port]
    ratios = [one / other for one, other in zip(ours, theirs, strict=True)]
    print(f"port      {statistics.median(theirs):6.2f} ms a scene (slowest {max(theirs):.2f})")
    print(f"emulator  {statistics.median(ours):6.2f} ms a scene (slowest {max(ours):.2f})")
    print(f"ratio     {statistics.median(ratios):6.2f} (largest {max(ratios):.2f})")
    print(f"typing in {statistics.median(typing):6.2f} ms a scene")


KERNELS = {
    "FOR and NEXT": "10 FOR I=1 TO 2000:NEXT",
    "IF and GOTO": "10 I=I+1:IF I<1000 THEN 10",
    "arithmetic": "10 FOR I=1 TO 300:X=(I+2)*3-I/7+A*B:NEXT",
    "array": "10 DIM A(20,20)\n20 FOR I=1 TO 20:FOR J=1 TO 20:A(I,J)=A(I,J)+I*J:NEXT J,I",
    "GOSUB": "10 FOR I=1 TO 500:GOSUB 100:NEXT:END\n100 RETURN",
    "FN": "10 DEF FN A(X)=X*X+1\n20 FOR I=1 TO 300:Y=FN A(I):NEXT",
    "strings": '10 FOR I=1 TO 300:A$=LEFT$("HELLO",3)+CHR$(65)+STR$(I):NEXT',
    "functions": "10 FOR I=1 TO 200:X=SIN(I)+SQR(I)+LOG(I):NEXT",
    "PRINT": '10 FOR I=1 TO 200:PRINT I;" ";I/3:NEXT',
}


def kernels() -> None:
    """Loops that do one thing: the fastest of several runs."""
    for name, program in KERNELS.items():
        machine = Applesoft()
        machine.load(program)
        times = []
        for _ in range(ROUNDS):
            start = time.process_time()
            machine.run()
            times.append((time.process_time() - start) * 1e3)
        print(f"{name:<13} {min(times):6.2f} ms")


def assigned() -> str:
    """The listing with sample 1's velocities assigned in lines 210 and 230."""
    text = packaged_text("impact88.legacy", "impact.bas")
    scene = sample(1)
    for line, names in (("210 INPUT UX,UY,WA", "UX UY WA"), ("230 INPUT VX,VY,WB", "VX VY WB")):
        number = line.split(" ", 1)[0]
        values = ":".join(f"{name}={scene[name]}" for name in names.split())
        text = text.replace(line, f"{number} {values}")
    return text


PCBASIC = """
import sys, time
from pcbasic import Session
text = sys.stdin.read()
with Session(input_streams=None, output_streams=None) as session:
    for line in text.splitlines():
        session.execute(line)
    for _ in range({rounds}):
        start = time.process_time()
        session.execute("RUN")
        print((time.process_time() - start) * 1e3)
"""


def against_pcbasic(python: str) -> None:
    """The same listing, velocities assigned, under PC-BASIC and in the emulator: RUN alone."""
    text = assigned()
    script = PCBASIC.format(rounds=ROUNDS)
    done = subprocess.run(
        [python, "-c", script], input=text, capture_output=True, text=True, check=True
    )
    theirs = statistics.median(map(float, done.stdout.split()))
    machine = Applesoft(dos=True)
    machine.load(text)
    machine.run()
    ours = []
    for _ in range(5 * ROUNDS):
        start = time.process_time()
        machine.run()
        ours.append((time.process_time() - start) * 1e3)
    median = statistics.median(ours)
    print(f"PC-BASIC  {theirs:6.1f} ms, emulator {median:.2f} ms: {theirs / median:.0f} times")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="emulator against port and PC-BASIC")
    parser.add_argument("--pcbasic", metavar="PYTHON", help="a Python that has PC-BASIC installed")
    arguments = parser.parse_args()
    in_process()
    kernels()
    if arguments.pcbasic:
        against_pcbasic(arguments.pcbasic)


if __name__ == "__main__":
    main()
