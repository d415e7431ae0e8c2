"""Rules of Applesoft that no captured program shows: each by the ROM's rule, in a few lines."""

from __future__ import annotations

from contextlib import suppress

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from impact88.apple.applesoft.console import EndOfInput
from impact88.apple.applesoft.errorcodes import ApplesoftError
from impact88.apple.captured import session
from impact88.apple.emulator.emulator import Applesoft
from impact88.apple.emulator.faults import TooManyStatements
from impact88.apple.emulator.tokens import KEYWORDS, TOKENS, detokenise, split_number, tokenise

BEL = "\a"


def output(program: str, keys: str = "") -> str:
    return session(program, keys)[1]


@pytest.mark.parametrize(
    ("text", "tokens"),
    [
        ("PRINT", bytes([TOKENS["PRINT"]])),
        ("P R I N T A", bytes([TOKENS["PRINT"]]) + b"A"),
        ("A T N", bytes([TOKENS["AT"]]) + b"N"),
        ("A TN", bytes([TOKENS["ATN"]])),
        ("ATO", b"A" + bytes([TOKENS["TO"]])),
        ("ATTO", bytes([TOKENS["AT"], TOKENS["TO"]])),
        ("TOTAL", bytes([TOKENS["TO"]]) + b"TAL"),
        ("GOTOTO", bytes([TOKENS["GOTO"], TOKENS["TO"]])),
        ("HGR2", bytes([TOKENS["HGR2"]])),
        ("print", b"print"),
        ('? "a ?"', bytes([TOKENS["PRINT"]]) + b'"a ?"'),
        ("DATA  ?A: ?A", bytes([TOKENS["DATA"]]) + b"  ?A:" + bytes([TOKENS["PRINT"]]) + b"A"),
        ('DATA ":": A', bytes([TOKENS["DATA"]]) + b' ":":A'),
        ("REM  FOR : ?", bytes([TOKENS["REM"]]) + b"  FOR : ?"),
        ("1E - 9", b"1E" + bytes([TOKENS["-"]]) + b"9"),
    ],
)
def test_tokens(text, tokens):
    assert tokenise(text) == tokens
    assert tokenise(detokenise(tokens)) == tokens


@pytest.mark.parametrize(
    ("text", "number", "rest"),
    [("10PRINT", 10, "PRINT"), (" 1 2 A", 12, "A"), ("63999", 63999, ""), ("0A", 0, "A")],
)
def test_line_numbers(text, number, rest):
    assert split_number(text) == (number, rest)


def test_line_numbers_end_at_63999():
    assert split_number("PRINT 1") is None
    with pytest.raises(ValueError, match="63999"):
        split_number("64000 END")


@pytest.mark.parametrize(
    ("program", "expected"),
    [
        ("10 FOR I=3 TO 1:PRINT I:NEXT", "3\n"),
        ("10 FOR I=1 TO 3:PRINT I;:I=I+1:NEXT", "13"),
        ('10 PRINT "A",,"B"', "A" + " " * 31 + "B\n"),
        ('10 A$="AB":B$=A$:A$="C":PRINT B$;A$', "ABC\n"),
        ("10 DIM A(1,2,3):A(1,2,3)=7:A(0,2,3)=6:PRINT A(1,2,3);A(0,2,3)", "76\n"),
        ("10 IF 1 THEN IF 0 THEN PRINT 1\n20 PRINT 2", "2\n"),
        ("10 IF 1 GOTO 30\n20 PRINT 2\n30 PRINT 3", "3\n"),
        ("10 ON 3 GOTO 20,30:PRINT 1\n20 PRINT 2\n30 PRINT 3", "1\n2\n3\n"),
        ("10 ON 2 GOSUB 20,30:PRINT 1:END\n20 PRINT 2:RETURN\n30 PRINT 3:RETURN", "3\n1\n"),
        ("10 DEF FN A(X)=X*2:DEF FN B(X)=FN A(X)+X:PRINT FN B(3)", "9\n"),
        ('10 READ A$,B$:PRINT A$B$:RESTORE:READ A$:PRINT A$:DATA X,"Y', "XY\nX\n"),
        ("10 DATA 1,,3\n20 READ A,B$,C:PRINT A;B$;C", "13\n"),
        ("10 A%=-1.5:A=A%:PRINT A", "-2\n"),
        ("10 PRINT 1<=>2;1=>2", "10\n"),
        ("10 PRINT NOT 1=0;-2^2;2^-1^2", "14.25\n"),
        ("10 PRINT (1=1)+(2=2)", "2\n"),
        ('10 PRINT LEFT$("ABC",2)+RIGHT$("ABC",1)+MID$("ABC",2,1)', "ABCB\n"),
        ("10 GOTO 20X\n20 PRINT 1", "1\n"),
        ("10 POP:PRINT 1", f"\n?RETURN WITHOUT GOSUB ERROR{BEL} IN 10"),
        ("10 PRINT 1;:PRINT A+", f"1\n?SYNTAX ERROR{BEL} IN 10"),
        ('10 PRINT "A"+1', f"\n?TYPE MISMATCH ERROR{BEL} IN 10"),
        ("10 A$=1", f"\n?TYPE MISMATCH ERROR{BEL} IN 10"),
        ("10 PRINT 1/0+)", f"\n?DIVISION BY ZERO ERROR{BEL} IN 10"),
        ("10 PRINT 1/0*+)", f"\n?DIVISION BY ZERO ERROR{BEL} IN 10"),
        ("10 PRINT 1/(0*)", f"\n?SYNTAX ERROR{BEL} IN 10"),
        ("10 FOR I%=1 TO 2", f"\n?SYNTAX ERROR{BEL} IN 10"),
        ("10 A%=32768", f"\n?ILLEGAL QUANTITY ERROR{BEL} IN 10"),
        ("10 A%=-32768:PRINT A%", f"\n?ILLEGAL QUANTITY ERROR{BEL} IN 10"),
        ("10 PRINT CHR$(256)", f"\n?ILLEGAL QUANTITY ERROR{BEL} IN 10"),
        ("10 DIM A(5):DIM A(5)", f"\n?REDIM'D ARRAY ERROR{BEL} IN 10"),
        ("10 PRINT A(-1)", f"\n?ILLEGAL QUANTITY ERROR{BEL} IN 10"),
        ("10 GR", f"\n?SYNTAX ERROR{BEL} IN 10"),
        ('10 FOR I=1 TO 9:A$=A$+A$+"XX":NEXT', f"\n?STRING TOO LONG ERROR{BEL} IN 10"),
        (
            '10 FOR I=1 TO 5:IF "A" THEN PRINT I\n20 NEXT',
            f"1\n2\n\n?FORMULA TOO COMPLEX ERROR{BEL} IN 10",
        ),
    ],
)
def test_programs(program, expected):
    assert output(program) == expected


def test_a_keyword_inside_hides_the_rest():
    # XOR is X OR: 5X is 5 and then a variable
    assert output("10 X=1:PRINT 5 XOR 3") == "51\n"


def nested_loops(n: int) -> str:
    names = "ABCDEFGHIJKLM"[:n]
    return "".join(f"{10 * i} FOR {v}=1 TO 1\n" for i, v in enumerate(names, 1)) + "900 PRINT 1\n"


def test_ten_loops_deep_and_no_deeper():
    assert output(nested_loops(10)) == "1\n"
    assert output(nested_loops(11)) == f"\n?OUT OF MEMORY ERROR{BEL} IN 110"


@pytest.mark.parametrize(
    ("loops", "subroutines", "last", "fits"),
    [
        # the stack begins at 248, a loop takes 18 bytes and a subroutine 7; CHKMEM asks for nine
        # words of a loop, three of a subroutine, and 54 bytes more
        (5, 12, "FOR Z=1 TO 1", True),  # at 74
        (0, 25, "FOR Z=1 TO 1", False),  # at 73
        (4, 16, "GOSUB 900", True),  # at 64
        (6, 11, "GOSUB 900", False),  # at 63
        (2, 21, "X=1", True),  # a formula asks for a word, at 59
        (4, 16, "X=1", False),  # at 58
        (6, 9, "X=1+1", True),
        (1, 22, "X=1+1", False),
    ],
)
def test_loops_and_subroutines_share_the_stack(loops, subroutines, last, fits):
    lines = [f"FOR A{number}=1 TO 1" for number in range(loops)]
    lines += [f"GOSUB {10 * (loops + number + 1)}" for number in range(subroutines)]
    program = "\n".join(f"{10 * number} {line}" for number, line in enumerate([*lines, last]))
    error = f"\n?OUT OF MEMORY ERROR{BEL} IN {10 * len(lines)}"
    assert output(f"{program}\n900 END") == ("" if fits else error)


def test_parentheses_as_deep_as_the_stack():
    def program(n: int) -> str:
        return f"10 PRINT {'(' * n}1{')' * n}"

    deepest = next(n for n in range(100) if "MEMORY" in output(program(n)))
    # PRINT begins 4 bytes down, each parenthesis takes 5, 59 of 248 must stay
    assert deepest == (248 - 59 - 4) // 5 + 1


def test_the_stack_decides_at_the_moment():
    """25 subroutines deep an addition does not fit, a constant does."""
    program = "10 N=N+1:IF N<{n} THEN GOSUB 10\n20 PRINT {what}:END"
    assert output(program.format(n=24, what="N+N")) == "48\n"
    error = f"\n?OUT OF MEMORY ERROR{BEL} IN 10"
    assert output(program.format(n=99, what="N")) == error


def test_an_error_under_onerr_hides_the_loops_until_resume():
    program = (
        "10 ONERR GOTO 50\n20 FOR I=1 TO 2:D=1-1:PRINT 1/D:NEXT\n40 END\n"
        "50 PRINT PEEK(222):N=N+1:IF N=2 THEN POKE 216,0\n60 {way}"
    )
    assert output(program.format(way="NEXT")) == f"133\n0\n\n?NEXT WITHOUT FOR ERROR{BEL} IN 60"
    assert output(program.format(way="CALL -3288:NEXT")) == ("133\n133\n")


def test_stop_and_cont():
    assert output("10 PRINT 1:STOP:PRINT 2\n20 PRINT 3", "CONT\nCONT\n") == (
        f"1\n\nBREAK{BEL} IN 10\n]CONT\n2\n3\n\n]CONT\n"
    )


def test_run_of_a_missing_line_shows_what_becomes_of_the_line_number():
    _, response = session("20 PRINT 1", "RUN 99\n")
    assert response.endswith(f"?UNDEF'D STATEMENT ERROR{BEL} IN 65044")


def test_a_loop_typed_at_the_prompt():
    assert output("10 REM", "FOR I=1 TO 3:PRINT I;:NEXT:PRINT\n") == (
        "\n]FOR I=1 TO 3:PRINT I;:NEXT:PRINT\n123\n"
    )


def test_trace_counts_statements_not_ifs():
    program = '10 TRACE:FOR I=1 TO 2:IF I=1 THEN PRINT "A"\n20 NEXT:NOTRACE'
    assert output(program) == "#10 #10 A\n#20 #10 #20 #20 "


def test_get_of_a_wrong_key_believes_it_is_at_the_prompt():
    assert output("10 GET A", "X") == f"\n?SYNTAX ERROR{BEL}"


def test_a_bad_reply_under_onerr_is_code_254():
    program = "10 ONERR GOTO 30\n20 INPUT A:PRINT A:END\n30 PRINT PEEK(222):RESUME"
    assert output(program, "X\n7\n") == "?X\n254\n?7\n7\n"


def test_control_c_as_a_reply_breaks():
    assert output("10 INPUT A", "\x03\nPRINT 5\n") == f"?\x03\n\nBREAK{BEL} IN 10\n]PRINT 5\n5\n"


def test_input_into_an_integer_variable():
    assert output("10 INPUT A%:PRINT A%", "3.7\n") == "?3.7\n3\n"


def test_strings_take_room_unless_the_program_holds_them():
    program = '10 A$="X":B$=A$:C$=A$+"Y":D$="":PRINT {}'
    free = 0xC000 - (0x801 + len(tokenise(program.format("FRE(0)")[3:])) + 7) - 4 * 7
    assert output(program.format("FRE(0)")) == f"{free - 2 - 65536}\n"


def test_himem_and_lomem_bound_the_room():
    assert output("10 HIMEM:2200:DIM A(50)") == f"\n?OUT OF MEMORY ERROR{BEL} IN 10"
    assert output("10 A=1:LOMEM:4000:PRINT A;PEEK(105)+256*PEEK(106)") == "04000\n"


@pytest.mark.parametrize(
    ("name", "statement", "response"),
    [((65, 128), 'A$="XYZ"', "LEN(A$)"), ((65, 0), "A=5", "A"), ((193, 128), "A%=5", "A%")],
)
def test_a_variable_in_the_addresses_of_devices_keeps_nothing(
    name: tuple[int, int], statement: str, response: str
) -> None:
    """Its name is the last two bytes of RAM, its value begins at $C000."""
    first, second = name
    assert (
        output(
            f"10 POKE 49150,{first}:POKE 49151,{second}\n"
            f"20 POKE 107,5:POKE 108,192:POKE 105,254:POKE 106,191\n"
            f"30 {statement}:PRINT {response}"
        )
        == "0\n"
    )


def test_poke_changes_a_token_of_the_running_program():
    # line 20's + becomes -
    program = "10 POKE 2049+{at},201\n20 PRINT 5+2"
    at = 4 + len(tokenise("POKE 2049+99,201")) + 1 + 4 + 2
    assert output(program.format(at=at)) == "3\n"


def test_flash_sets_a_bit_in_what_is_sent():
    machine, response = session('10 HOME:FLASH:PRINT "A1":NORMAL')
    assert response == "Aq\n"
    assert machine.screen_text().startswith("A1\n")


@pytest.mark.parametrize(("top", "row"), [(0, 0), (2, 2), (1, 1)])
def test_the_cursor_does_not_go_up_beyond_the_window(top, row):
    machine, _ = session(f'10 POKE 34,{top}:HOME:CALL -998:PRINT "A";PEEK(37)')
    assert machine.screen_text().split("\n")[row] == f"A{row}"
    machine, _ = session(f'10 POKE 34,{top}:HOME:VTAB {top + 2}:CALL -998:PRINT "A";PEEK(37)')
    assert machine.screen_text().split("\n")[row] == f"A{row}"


def test_the_text_window():
    machine, _ = session('10 HOME:POKE 32,10:POKE 33,5:HOME:PRINT "ABCDEFG"')
    assert machine.screen_text().startswith(" " * 10 + "ABCDE\n" + " " * 10 + "FG\n")


def test_what_is_not_done_is_said():
    machine, response = session("10 CALL 24576", "GR\nPRINT PDL(0)\n")
    assert response.count("?SYNTAX ERROR") == 3
    assert machine.machine.refused == ["CALL 24576", "GR", "PDL"]


def test_disk_commands_are_named_once_and_passed_over():
    machine = Applesoft(dos=True)
    machine.load(
        '10 D$=CHR$(4):PRINT D$;"OPEN OUT,L20":PRINT D$"write OUT":PRINT "RESULT"\n'
        '20 PRINT D$;"OPEN B":PRINT D$:PRINT D$"PR#0":PRINT "X"D$"CLOSE"'
    )
    machine.run()
    assert machine.take_output() == "RESULT\nX\x04CLOSE\n"
    assert machine.machine.ignored == [
        "the disk command OPEN was passed over: there is no disk",
        "the disk command WRITE was passed over: there is no disk",
    ]


@pytest.mark.parametrize(
    ("program", "named"),
    [
        ("10 A=PEEK(-16336):A=PEEK(-16336)", [49200]),
        ("10 A=PEEK(78)+PEEK(79)", [78, 79]),
        ("10 POKE 6,1:A=PEEK(6)+PEEK(7)", [7]),
        ("10 A=PEEK(256)+PEEK(511)+PEEK(512)+PEEK(768)", [256, 511]),
        ("10 A=PEEK(53248)", [53248]),
        ("10 FOR I=1 TO 9:A=PEEK(-16336+I):NEXT", [*range(49201, 49209)]),
        ("10 A=PEEK(103)+PEEK(51)+PEEK(36)+PEEK(40)+PEEK(222)+PEEK(-1101)+PEEK(85)+PEEK(201)", []),
        ("10 A=PEEK(-16384)+PEEK(-16368)+PEEK(241)+PEEK(0)", []),
    ],
)
def test_peeks_at_what_is_not_modelled_are_named(program, named):
    machine, _ = session(program)
    assert machine.machine.ignored[:8] == [
        f"PEEK ({address}) gave 0: that byte is not modelled" for address in named
    ]
    assert len(machine.machine.ignored) <= 9


def test_a_program_that_waits_for_a_key_in_vain():
    machine = Applesoft()
    machine.load("10 WAIT -16384,128")
    with pytest.raises(EndOfInput):
        machine.run()
    machine.load("10 IF PEEK(-16384)>127 THEN PRINT PEEK(-16384)")
    machine.run()
    assert machine.take_output() == ""


@pytest.mark.parametrize(
    ("program", "keys", "address", "data"),
    [
        # what the ROM left there: the descriptor of the last text, LIST's place in a line
        ('10 PRINT "A";12', "", 0x55, (2, 0x00, 0x01)),
        ('10 PRINT "A"+"BC"', "", 0x55, (3, 0xFD, 0xBF)),
        ("10 STOP", "", 0x55, (2, 0x00, 0x01)),
        ("STOP", "", 0x55, (7, 0x5D, 0xD3)),
        ('10 PRINT "HELLO"', "LIST\n", 0x85, (4,)),
        ('10 A=1:B=2:PRINT "HELLO"', "LIST\n", 0x85, (12,)),
        ("10 INPUT A", "5\n", 0x33, (0xDD,)),
    ],
)
def test_page_zero_after_a_run(program, keys, address, data):
    machine, _ = session(program, keys)
    assert tuple(machine.machine.peek(address + place) for place in range(len(data))) == data


def test_a_line_feed_keeps_the_column():
    assert output('10 PRINT "A";CHR$(10);"B";POS(0)') == "A\nB2\n"


def test_a_string_is_where_its_descriptor_points():
    show = (
        "20 P=PEEK(105)+256*PEEK(106):S=PEEK(P+3)+256*PEEK(P+4)\n"
        "30 FOR I=0 TO PEEK(P+2)-1:PRINT CHR$(PEEK(S+I));:NEXT"
    )
    assert output(f'10 A$="HELLO"\n{show}') == "HELLO"
    assert output(f'10 A$="HE"+"Y"\n{show}') == "HEY"


def test_a_reply_past_the_buffer_is_abandoned():
    response = output("10 INPUT A$:PRINT LEN(A$)", "X" * 258 + "\n")
    assert response == "?" + "X" * 248 + f"X{BEL}" * 8 + "\\\nXX\n2\n"


def test_arrays_in_memory():
    program = (
        '10 DIM A(2,3):I=0:P=0:P=PEEK(107)+256*PEEK(108)\n20 FOR I=0 TO 8:PRINT PEEK(P+I);" ";:NEXT'
    )
    # name, length 9 + 12 * 5, two dimensions: 4 and 3 elements
    assert output(program) == "65 0 69 0 2 0 4 0 3 "


def test_a_program_in_python():
    machine = Applesoft()
    machine.load('10 INPUT A\n20 B$="Xy":C%=2.5:PRINT A/3\n30 DIM D(1)')
    machine.feed("1")
    assert machine.run() is None
    assert machine.take_output() == "?\x001\n.333333333\n"
    assert machine.reals() == {"A": "8100000000"}
    assert machine.value("A") == "8100000000"
    assert machine.value("B$") == "Xy"
    assert machine.value("C%") == "8200000000"
    assert machine.value("Z") is None
    assert machine.array("D") == {"dims": [2], "data": ["0000000000"] * 2}
    assert machine.array("E") is None
    assert machine.source() == '10 INPUT A\n20 B$ = "Xy":C% = 2.5: PRINT A / 3\n30 DIM D(1)\n'


def test_what_a_program_cannot_be():
    machine = Applesoft()
    for text, words in [
        ("PRINT 1", "row 1 has no line number"),
        ("10 A\n64000 B", "row 2"),
        ("10 " + "A" * 300, "row 1 has 300 characters"),
    ]:
        with pytest.raises(ValueError, match=words):
            machine.load(text)
    with pytest.raises(ApplesoftError, match="OUT OF MEMORY"):
        machine.load("".join(f"{n} REM {'X' * 200}\n" for n in range(300)))


def test_the_keyboard_ends_and_statements_run_out():
    machine = Applesoft()
    machine.load("10 INPUT A")
    with pytest.raises(EndOfInput):
        machine.run()
    machine.load("10 GOTO 10")
    machine.machine.statements_left = 1000
    with pytest.raises(TooManyStatements):
        machine.run()


def test_a_break_from_outside():
    machine = Applesoft()
    machine.load("10 N=N+1\n20 GOTO 10")
    machine.machine.after_line = lambda line: setattr(machine.machine, "interrupted", line == 10)
    machine.run()
    assert machine.machine.broken
    assert machine.take_output() == f"\nBREAK{BEL} IN 20"
    machine.machine.after_line = None
    machine.machine.statements_left = 10_000
    with pytest.raises(TooManyStatements):
        machine.enter("CONT")


def test_machines_do_not_share_values():
    first, second = Applesoft(), Applesoft()
    first.type_line("A=1:DIM B(3)")
    second.type_line("A=2")
    assert (first.value("A"), second.value("A")) == ("8100000000", "8200000000")
    assert second.array("B") is None


def test_a_terminal_shows_what_is_typed_itself():
    """The cursor is at the left after it, and a control-D line may begin there."""
    machine = Applesoft(dos=True, echo=False)
    machine.load('10 INPUT A\n20 PRINT POS(0),"X"\n30 INPUT A\n40 PRINT CHR$(4);"PR#0"')
    machine.feed("1", "2")
    machine.run()
    assert machine.take_output() == "?\x000" + " " * 15 + "X\n?\x00"


@pytest.mark.parametrize(
    ("program", "name", "value"),
    [
        ("10DEF FN  ABX$)=1", "AB%", "0000000000"),
        ('10 DEF FN A$(X)="Q"', "A%", "0000000000"),
        ('10 PRINT MDFNE LID$("AABC",0BC",0)', "EL%", "0000000000"),
        ("10 DEF FN A(X)=FN A(X-1)\n20 PRINT FN A(3)", "X", "83e0000000"),
    ],
)
def test_variables_that_an_error_leaves(program, name, value):
    """DEF FN with a string's name makes an integer variable; FN keeps its argument."""
    machine, _ = session(program)
    assert machine.value(name) == value


def test_a_program_may_set_any_window():
    program = "10 POKE 33,{}:POKE 32,{}:POKE 35,{}:POKE 34,{}:HOME:FOR I=1 TO 60:PRINT I:NEXT"
    for window in ((40, 0, 24, 24), (0, 200, 255, 250), (255, 255, 0, 255), (33, 39, 1, 0)):
        machine, response = session(program.format(*window))
        assert response.endswith("60\n")
        assert machine.screen_text().count("\n") == 24


@pytest.mark.parametrize("address", range(2049, 2090))
def test_a_program_may_poke_itself(address):
    lines = '10 POKE {0},5:PRINT "X":GOTO 20\n20 FOR I=1 TO 3:PRINT I:NEXT:POKE {0},0\n30 PRINT "Y"'
    machine, response = session(lines.format(address), "LIST\nRUN\n20 PRINT\nLIST\nRUN\n")
    assert response
    assert len(list(machine.machine.lines())) <= 5


def test_errors_that_nobody_clears_away_take_no_memory():
    machine = Applesoft()
    machine.load("10 ONERR GOTO 10\n20 GOTO 999")
    machine.machine.statements_left = 30_000
    with pytest.raises(TooManyStatements):
        machine.run()
    assert len(machine.machine.frames) < 10


def test_refusals_are_remembered_a_few_times():
    machine = Applesoft()
    machine.load("10 ONERR GOTO 20\n20 I=I+1:CALL I")
    machine.machine.statements_left = 5_000
    with pytest.raises(TooManyStatements):
        machine.run()
    assert len(machine.machine.refused) < 12


def test_strings_lie_where_the_program_can_see_them():
    program = '10 A$="AB"+"C":FOR I=49149 TO 49151:PRINT CHR$(PEEK(I));:NEXT:POKE 49150,90:PRINT A$'
    assert output(program) == "ABCAZC\n"


STEPS = st.lists(
    st.sampled_from([*KEYWORDS, *'ABTO?N1.:;,()$%=" ', "PO", "STE", "AT", "REM", "DATA"]),
    max_size=40,
)


@settings(max_examples=100)
@given(STEPS)
@example(["REM", " "])
def test_what_can_be_typed_survives_save_and_load(words):
    machine = Applesoft()
    machine.type_line(f"10 A{''.join(words)}"[:239])
    (line,) = machine.machine.lines()
    machine.load(machine.source())
    assert list(machine.machine.lines()) == [line]


def test_cont_goes_on_in_the_line_it_stands_in():
    """And after a subroutine called at the prompt the machine believes it is in line 0."""
    response = output("10 STOP\n20 PRINT 1/0", "CONT\n")
    assert response.endswith(f"\n?DIVISION BY ZERO ERROR{BEL} IN 20")
    response = output("10 REM", "20 PRINT 1:RETURN\nGOSUB 20\nCONT\n")
    assert response.endswith(f"?RETURN WITHOUT GOSUB ERROR{BEL} IN 0")


def test_the_echo_of_keys_is_never_inverse():
    machine, _ = session("10 HOME:INVERSE:INPUT A$:PRINT A$", "XY\n")
    rows = machine.screen_rows()
    assert rows[0][:3] == bytes((ord("?") & 0x3F, ord("X") | 0x80, ord("Y") | 0x80))
    assert rows[1][:2] == bytes((ord("X") & 0x3F, ord("Y") & 0x3F))


def test_a_temporary_that_onerr_left_is_in_the_way_of_numbers_too():
    program = '10 ONERR GOTO 30\n20 PRINT ("A"+"B")+("C"+"D"+LEFT$("X",0))\n30 POKE 216,0:PRINT {}'
    assert output(program.format('"X"')).startswith("\n?FORMULA TOO COMPLEX")
    assert output(program.format("1")).startswith("\n?FORMULA TOO COMPLEX")


@pytest.mark.parametrize(
    "program",
    [
        '10 PRINT 256^I%/"{0}"<>.5',
        '10 A=1:B$="X"+"Y":P=PEEK(105)+256*PEEK(106)\n20 FOR I=0 TO 60:POKE P+I,{0}:NEXT\n'
        "30 PRINT A;B$:DIM C(3),D$(2)\n40 FOR I=0 TO 90:POKE P+I,{0}:NEXT:PRINT C(1);D$(1);FRE(0)",
        "10 FOR I=2049 TO 2120:POKE I,{0}:NEXT:GOTO 10",
        "10 FOR I=105 TO 120:POKE I,{0}:NEXT:A=1:A$=STR$(A):DIM B(5):PRINT A$:GOTO 10",
    ],
)
@pytest.mark.parametrize("byte", [0, 1, 7, 128, 200, 255])
def test_a_program_may_poke_its_own_text_and_variables(program, byte):
    machine = Applesoft()
    machine.load(program.format(byte))
    machine.machine.statements_left = 2000
    for line in ("RUN", "LIST", "PRINT A;B;C$", "NEW"):
        with suppress(TooManyStatements):
            machine.type_line(line)
    machine.reals()
    machine.array("C")
    machine.screen_text()


@pytest.mark.parametrize(
    ("expression", "printed"),
    [
        ('256^I%/"128"<>.5', "\n?TYPE MISMATCH ERROR\a IN 10"),
        ('7/"ABCDEFG">.5', "\n?TYPE MISMATCH ERROR\a IN 10"),
        ('256^1/"128"<>.5', "\n?OVERFLOW ERROR\a IN 10"),
        ('.001/"A"="A"', "0\n"),
        ('3/"A"', "\n?TYPE MISMATCH ERROR\a IN 10"),
    ],
)
def test_a_string_as_divisor_divides_by_its_descriptor(expression, printed):
    assert output(f"10 PRINT {expression}") == printed  # as the ROM answers


def test_a_program_run_before_leaves_nothing_behind():
    text = '10 A=A+1:B$=B$+"X":PRINT A;B$;FRE(0);RND(1)\n20 POKE 2055,66'
    response = [output(text), output("10 POKE 2055,67:A=7"), output(text)]
    assert response[0] == response[2]


def stack_at_error(line: str) -> int:
    """The stack pointer at the ROM's jump to ERROR, of a line typed without a number."""
    machine = Applesoft(lambda: None)
    machine.enter(line)
    return machine.machine.error.stack


def test_an_error_is_detected_below_the_routines_that_lead_to_it():
    """Each JSR takes two bytes of the stack, which ONERR leaves there."""
    # EXP calls OUTOFRNG; LOG jumps to its error
    assert stack_at_error("X=EXP(99)") == stack_at_error("X=LOG(0)") - 2
    # CONINT calls MKINT, which refuses a minus sign and what is no integer; from 256 on it refuses
    assert stack_at_error("PRINT CHR$(-1)") == stack_at_error("PRINT CHR$(256)") - 2
    assert stack_at_error("PRINT CHR$(32768)") == stack_at_error("PRINT CHR$(256)") - 2
    assert stack_at_error("PRINT CHR$(32767)") == stack_at_error("PRINT CHR$(256)")
    # STR$ calls CHKNUM, DEF calls FNC, which calls SYNCHR as DEF itself does
    assert stack_at_error('PRINT STR$("A")') == stack_at_error("PRINT LOG(0)") - 2
    assert stack_at_error("DEF A") == stack_at_error("DEF FN A(X)=X") - 2
    # READ and LET both call PTRGET
    assert stack_at_error("READ 1") == stack_at_error("LET 1=2")
    # statements are called by one JSR
    assert stack_at_error("CONT") == stack_at_error("GOTO 999") == 0xF8 - 2


@pytest.mark.parametrize(
    ("address", "rows"),
    [
        (-936, ["!"]),  # HOME
        (-912, ["", "", "ABCDE", "FG!", ""]),  # SCROLL
        (-922, ["", "", "", "ABCDE", "FG!"]),  # LF
        (-998, ["", "", "  !", "ABCDE", "FGH"]),  # UP
        (-1008, ["", "", "", "A!CDE", "FGH"]),  # BS
        (-1036, ["", "", "", "ABC!E", "FGH"]),  # ADVANCE
        (-926, ["", "", "", "ABCDE", "!GH"]),  # CR
        (-868, ["", "", "", "AB!", "FGH"]),  # CLREOL
        (-958, ["", "", "", "AB!"]),  # CLREOP
    ],
)
def test_the_monitor_s_routines_for_the_screen(address, rows):
    """The Apple II Reference Manual describes them; the cursor is on the C of ABCDE."""
    machine, _ = session(
        '10 HOME:VTAB 4:HTAB 1:PRINT "ABCDE":PRINT "FGH";:VTAB 4:HTAB 3:'
        f'CALL {address}:PRINT "!";:VTAB 20'
    )
    assert [row.rstrip() for row in machine.screen_text().split("\n")][: len(rows)] == rows
