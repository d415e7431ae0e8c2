"""A ROM of our own for the tests of `romapple`: a prompt, a line reader, and a RUN that
plays back a printout and leaves variables.

It has what `romapple` uses of an Apple II Plus: the reset vector, a keyboard loop, COUT, the
pointers of Applesoft's memory, numbered lines kept as program text, POKE, and a few entry points of
the arithmetic. It computes nothing.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

START = 0xD000
CODE = 0xE000
VALUES = 0xD800
COUT = 0xFDED

_OPCODES = {  # mnemonic: mode -> opcode
    "LDA": {"#": 0xA9, "z": 0xA5, "a": 0xAD, "ax": 0xBD, "iy": 0xB1},
    "LDX": {"#": 0xA2, "z": 0xA6},
    "LDY": {"#": 0xA0, "z": 0xA4},
    "STA": {"z": 0x85, "a": 0x8D, "ax": 0x9D, "iy": 0x91},
    "STX": {"z": 0x86},
    "STY": {"z": 0x84},
    "CMP": {"#": 0xC9, "ax": 0xDD},
    "CPX": {"#": 0xE0},
    "CPY": {"#": 0xC0},
    "ADC": {"#": 0x69, "z": 0x65},
    "SBC": {"#": 0xE9},
    "AND": {"#": 0x29},
    "ORA": {"#": 0x09},
    "EOR": {"#": 0x49},
    "INC": {"z": 0xE6},
    "BIT": {"a": 0x2C},
    "JMP": {"a": 0x4C},
    "JSR": {"a": 0x20},
    **{
        name: {"r": code}
        for name, code in (
            ("BPL", 0x10), ("BMI", 0x30), ("BCC", 0x90),
            ("BCS", 0xB0), ("BNE", 0xD0), ("BEQ", 0xF0),
        )
    },
    **{
        name: {"": code}
        for name, code in (
            ("RTS", 0x60), ("INX", 0xE8), ("INY", 0xC8), ("CLC", 0x18), ("SEC", 0x38),
            ("TAX", 0xAA), ("TXA", 0x8A), ("PHA", 0x48), ("PLA", 0x68), ("DEX", 0xCA),
        )
    },
}  # fmt: skip

_PROGRAM = """
reset:  LDA #$01        ; the program begins at $0801 and is empty
        STA $67
        LDA #$08
        STA $68
        LDA #$01
        STA $40
        LDA #$08
        STA $41
        JSR close
        LDA #$8D
        JSR cout
prompt: LDA #$8D
        JSR cout
        LDA #$DD        ; ]
        JSR cout
        JSR getln
        LDA $0200
        CMP #$30
        BCC prompt
        CMP #$3A
        BCC numbered
        CMP #$52        ; R of RUN
        BEQ run
        LDX #$05        ; POKE address,value
        JSR decimal
        LDA $50
        STA $42
        LDA $51
        STA $43
        INX
        JSR decimal
        LDY #$00
        LDA $50
        STA ($42),Y
        JMP prompt
run:    JMP play

numbered: LDX #$00
        JSR decimal
        LDY #$02
        LDA $50
        STA ($40),Y
        INY
        LDA $51
        STA ($40),Y
        INY
        INX             ; the blank after the number
copy:   LDA $0200,X
        CMP #$0D
        BEQ copied
        STA ($40),Y
        INX
        INY
        BNE copy
copied: LDA #$00
        STA ($40),Y
        INY
        CLC
        TXA
        LDA $40
        STA $42
        LDA $41
        STA $43
        STY $44
        CLC
        LDA $40
        ADC $44
        STA $40
        LDA $41
        ADC #$00
        STA $41
        LDY #$00
        LDA $40
        STA ($42),Y
        INY
        LDA $41
        STA ($42),Y
        JSR close
        JMP prompt

close:  LDY #$00        ; two zero bytes end the program
        LDA #$00
        STA ($40),Y
        INY
        STA ($40),Y
        RTS

decimal: LDA #$00       ; a number at $0200,X into $50/$51
        STA $50
        STA $51
digit:  LDA $0200,X
        CMP #$30
        BCC read
        CMP #$3A
        BCS read
        SEC
        SBC #$30
        STA $52
        LDA $50
        STA $53
        LDA $51
        STA $54
        LDY #$09
times:  CLC
        LDA $50
        ADC $53
        STA $50
        LDA $51
        ADC $54
        STA $51
        INY
        CPY #$12
        BNE times
        CLC
        LDA $50
        ADC $52
        STA $50
        LDA $51
        ADC #$00
        STA $51
        INX
        BNE digit
read:   RTS

getln:  LDX #$00        ; a line into $0200, in capitals, echoed
key:    INC $4E
        BIT $C000
        BPL key
        LDA $C000
        BIT $C010
        CMP #$E0
        BCC capital
        AND #$DF
capital: PHA
        AND #$7F
        STA $0200,X
        PLA
        JSR cout
        INX
        CMP #$8D
        BNE key
        RTS

play:   LDA #values     ; the text to be shown begins at VALUES
        STA $46
        LDA #values_high
        STA $47
next:   LDY #$00
        LDA ($46),Y
        INC $46
        BNE same
        INC $47
same:   CMP #$FF        ; the end
        BEQ finish
        CMP #$FE        ; INPUT
        BEQ input
        CMP #$7F        ; on by a column
        BEQ skip
        ORA #$80
        JSR cout
        JMP next
input:  JSR getln
        JMP next
skip:   INC $24
        JMP next
finish: LDX #$00        ; pointers: variables, arrays, the end
point:  LDA pointers,X
        STA $69,X
        INX
        CPX #$06
        BNE point
        LDA #tables
        STA $46
        LDA #tables_high
        STA $47
        LDA #$00
        STA $48
        LDA #$60
        STA $49
        LDX #$04        ; four pages of them, to $6000
page:   LDY #$00
byte:   LDA ($46),Y
        STA ($48),Y
        INY
        BNE byte
        INC $47
        INC $49
        DEX
        BNE page
        JMP prompt
"""

_COUT = """
cout:   CMP #$8D        ; as far as the cursor's column goes
        BEQ left
        CMP #$A0
        BCC shown
        INC $24
shown:  RTS
left:   PHA
        LDA #$00
        STA $24
        PLA
        RTS
"""

_ENTRIES = {
    0xD412: ["RTS"],
    0xEA66: ["LDX #$85", "JMP $D412"],  # DIVISION BY ZERO, whatever is divided
    0xEED0: ["LDA $A2", "EOR #$FF", "STA $A2", "RTS"],
    0xED34: ["LDA #$10", "LDY #$E9", "RTS"],
    0xEBB2: ["LDA #$01", "RTS"],
    0xEB2B: [
        "STX $46", "STY $47", "LDY #$04", "LDA $A1", "STA ($46),Y", "LDY #$03", "LDA $A0",
        "STA ($46),Y", "LDY #$02", "LDA $9F", "STA ($46),Y", "LDA $A2", "ORA #$7F", "STA $48",
        "LDA $9E", "LDY #$01", "STA ($46),Y", "LDA $48", "BMI minus", "LDA ($46),Y", "AND #$7F",
        "STA ($46),Y", "minus:", "LDY #$00", "LDA $9D", "STA ($46),Y", "RTS",
    ],
}  # fmt: skip
"""Entry points of the arithmetic, and their addresses."""


def assemble(lines: list[str], origin: int, symbols: Mapping[str, int]) -> tuple[bytes, dict]:
    """Machine code, and where its labels are."""
    labels = dict(symbols)
    for _ in range(2):
        code = bytearray()
        for line in lines:
            line = line.partition(";")[0].strip()
            label = re.match(r"(\w+):\s*", line)
            if label:
                labels[label.group(1)] = origin + len(code)
                line = line[label.end() :]
            if line:
                code += _instruction(line, origin + len(code), labels)
    return bytes(code), labels


def _instruction(line: str, place: int, labels: Mapping[str, int]) -> bytes:
    name, _, operand = line.partition(" ")
    modes = _OPCODES[name]
    mode, match = "", None
    for pattern, mode in (  # noqa: B007
        (r"#(.+)", "#"), (r"\((.+)\),Y", "iy"), (r"(.+),X", "ax"), (r"(.+)", "a"), (r"()", ""),
    ):  # fmt: skip
        if match := re.fullmatch(pattern, operand.strip()):
            break
    text = match.group(1) if match else ""
    value = int(text[1:], 16) if text.startswith("$") else labels.get(text, 0)
    if "r" in modes:
        return bytes([modes["r"], value - place - 2 & 0xFF])
    if mode == "a" and text.startswith("$") and len(text) == 3 and "z" in modes:
        mode = "z"
    if mode == "":
        return bytes([modes[""]])
    if mode in ("a", "ax"):
        return bytes([modes[mode], value & 0xFF, value >> 8])
    return bytes([modes[mode], value & 0xFF])


def rom(text: str, reals: Mapping[str, str], a: Mapping[str, Any] | None) -> bytes:
    """A ROM whose RUN shows ``text`` (what follows each ``?\\0`` is typed there, up to the end of
    its line; DEL moves the cursor on) and leaves these variables and the array A."""
    text = text.replace("\n", "\r")
    played = b"".join(
        piece.encode("ascii") if index == 0 else b"\xfe" + piece.partition("\r")[2].encode("ascii")
        for index, piece in enumerate(re.split(r"(?<=\?\0)", text))
    )
    table = b"P\x80\x05\x00\x00\x00\x00"  # a string, P$, is not a real
    for name, stored in reals.items():
        table += name.ljust(2, "\0").encode("ascii") + bytes.fromhex(stored)
    arrays = b""
    if a is not None:
        data = bytes.fromhex("".join(a["data"]))
        sizes = b"".join(size.to_bytes(2, "big") for size in reversed(a["dims"]))
        other = b"B\0" + (12).to_bytes(2, "little") + b"\x01" + b"\0\x01" + bytes(5)
        length = 5 + len(sizes) + len(data)
        arrays = other + b"A\0" + length.to_bytes(2, "little") + bytes([len(a["dims"])])
        arrays += sizes + data
    ends = [0x6000, 0x6000 + len(table), 0x6000 + len(table) + len(arrays)]
    pointers = b"".join(end.to_bytes(2, "little") for end in ends)
    tables = VALUES + len(played) + 1
    place = tables + len(table + arrays)
    symbols = {
        "cout": COUT,
        "values": VALUES & 0xFF,
        "values_high": VALUES >> 8,
        "tables": tables & 0xFF,
        "tables_high": tables >> 8,
        "pointers": place,
    }
    image = bytearray(0x10000)
    image[VALUES:place] = played + b"\xff" + table + arrays
    image[place : place + 6] = pointers
    code, labels = assemble(_PROGRAM.splitlines(), CODE, symbols)
    for origin, lines in {COUT: _COUT.splitlines(), **_ENTRIES}.items():
        piece, _ = assemble(lines, origin, labels)
        image[origin : origin + len(piece)] = piece
    image[CODE : CODE + len(code)] = code
    image[0xE910:0xE918] = b"2.718282"
    image[0xFFFC:0xFFFE] = CODE.to_bytes(2, "little")
    return bytes(image[START:])
