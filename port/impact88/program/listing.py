"""The listing: lines 100-1170 of the 1988 program, each above its translation.

Compare it with the printed page. Every line of `impact.bas` is here once, in order, as a comment;
the Python under it does what that line does, with the listing's names (P$ is ``P_``) and in an
arithmetic given as a parameter. Nothing is improved: what is odd in the original is odd here.

How to read it: ``LET`` is a store, which rounds; elements of A round by themselves. ``C_1E4`` is the
constant 1E4. GOTOs are the ifs they amount to: ``IF c THEN n`` skips, so the lines it skips are
under ``if not c``. NEXT adds one and goes round again unless the limit is passed, so a loop's body
runs at least once and its variable ends one past the limit. NL ends a PRINT that no ``;`` ends. The
subroutines at 1000 and 1070 are functions that share the variables.

The port does not track line numbers: the BASIC line being executed is found from the comment above
the Python line being executed (`run.basic_line`), for the line of an error and for stopping after
every line.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ..apple.applesoft.arrays import Array
from ..apple.applesoft.console import Console
from .arithmetics import Arithmetic

# A line of BASIC is a line of Python here, as long as it takes, and keeps BASIC's comparisons.
# ruff: noqa: E501, E702, E741, F841, SIM201, SIM202, SIM300
# fmt: off


class End(Exception):
    """END inside a subroutine."""


class Printer:
    """PRINT: ``PRINT << item << item`` prints each item as soon as it is worked out, as the ROM
    does, so that an error in the third leaves the first two on the screen."""

    __slots__ = ("_put", "_write")

    def __init__(self, console: Console, write: Callable[[Any], str]) -> None:
        self._put = console.put
        self._write = write

    def __lshift__(self, item: Any) -> Printer:
        self._put(item if item.__class__ is str else self._write(item))
        return self


def impact(
    data: Mapping[str, str], arithmetic: Arithmetic, console: Console
) -> dict[str, Any]:
    """Run the program: print to ``console``, read the velocities from it.

    ``data`` holds the texts of lines 280, 290, 310 and of M in 350 under the listing's names.
    Returns the local names, the variables among them
    (`run` sorts them out). Raises the arithmetic's errors, `End` after ZERO
    DETERMINANT, and `console.EndOfInput`; the variables are then in the traceback's frame.
    """
    LET, NEXT, INT, ABS, SIN, COS = (
        arithmetic.LET,
        arithmetic.NEXT,
        arithmetic.INT,
        arithmetic.ABS,
        arithmetic.SIN,
        arithmetic.COS,
    )
    ZERO, UNSET = arithmetic.zero, arithmetic.unset
    C_1, C_6, C_10, C_1E3, C_1E4, C_1E_9, C_3_14159265 = map(
        arithmetic.number, ("1", "6", "10", "1E3", "1E4", "1E-9", "3.14159265")
    )

    def DATA(name: str) -> Any:
        return arithmetic.number(data[name])

    def INPUT() -> Any:
        return console.input(arithmetic.read)

    PRINT = Printer(console, arithmetic.write)
    NL = "\n"

    def DIM(*sizes: Any) -> Array:
        return Array(sizes, LET, ZERO)

    def CHR(code: int) -> str:
        return chr(code & 0x7F)

    # A variable reads as zero until it is assigned.
    UX = UY = WA = VX = VY = WB = E = MU = EM = DA = DB = GA = PA = PB = TA = TB = UNSET
    AG = MA = MB = IA = IB = KI = D1 = D2 = D3 = D4 = XA = YA = XB = YB = N = M = UNSET
    J = I = MX = CO = RO = RX = AP = OL = AS = AR = KF = UNSET
    A: Any = None

    def main() -> None:  # not split: the listing's lines in order
        nonlocal UX, UY, WA, VX, VY, WB, E, MU, EM, DA, DB, GA, PA, PB, TA, TB, AG, MA, MB, IA
        nonlocal IB, KI, D1, D2, D3, D4, XA, YA, XB, YB, N, M, KF, A
        # 100 REM THIS PROGRAM CALCULATES THE FINAL VELOCITIES OF AN IMPACT BETWEEN TWO RIGID BODIES
        # 110 REM
        # 120 REM EQUATIONS SOLVED ARE THOSE IN SAE PAPER #770014, R. M. Brach
        # 130 REM
        # 140 REM E, COEFFICIENT OF RESTITUTION: 0 < E < 1
        # 150 REM EM, MOMENT COEFFICIENT OF RESTITUTION: -1 < EM < 0
        # 160 REM MU, EQUIVALENT FRICTION COEFFICIENT
        # 170 REM
        # 180 REM IN NEXT LINE "0" IS OUTPUT SLOT NUMBER (1 FOR PRINTER, 0 FOR MONITOR, ETC.)
        # 190 P$ = "PR# " + "0"
        P_ = "PR# " + "0"
        # 200 PRINT CHR$(140): PRINT "ENTER THE INITIAL VELOCITY COMPONENTS OF MA :Vax,Vay,Wa ";
        PRINT << CHR(140) << NL; PRINT << "ENTER THE INITIAL VELOCITY COMPONENTS OF MA :Vax,Vay,Wa "
        # 210 INPUT UX,UY,WA
        for reply in INPUT():
            UX = LET(reply(UX)); UY = LET(reply(UY)); WA = LET(reply(WA))
        # 220 PRINT : PRINT "ENTER THE INITIAL VELOCITY COMPONENTS OF MB :Vbx,Vby,Wb ";
        PRINT << NL; PRINT << "ENTER THE INITIAL VELOCITY COMPONENTS OF MB :Vbx,Vby,Wb "
        # 230 INPUT VX,VY,WB
        for reply in INPUT():
            VX = LET(reply(VX)); VY = LET(reply(VY)); WB = LET(reply(WB))
        # 240 REM
        # 250 REM IF FRICTION COEFFICIENT IS SET EQUAL TO -10,
        # 260 REM THE CONTACT POINT IS TREATED AS A PIVOT
        # 270 REM
        # 280 E = 0.005:MU = 0.911:EM = -0.715: REM ENTER COEFFICIENTS HERE
        E = LET(DATA("E")); MU = LET(DATA("MU")); EM = LET(DATA("EM"))
        # 290 DA = 7.59:DB = 3.44:GA = -30.0:PA = -19.8:PB = -38.7:TA = 0.0:TB = 60.0
        DA = LET(DATA("DA")); DB = LET(DATA("DB")); GA = LET(DATA("GA")); PA = LET(DATA("PA")); PB = LET(DATA("PB")); TA = LET(DATA("TA")); TB = LET(DATA("TB"))
        # 300 AG = 3.14159265 / 180:GA = GA * AG:PA = PA * AG:PB = PB * AG:TA = TA * AG:TB = TB * AG
        AG = LET(C_3_14159265 / 180); GA = LET(GA * AG); PA = LET(PA * AG); PB = LET(PB * AG); TA = LET(TA * AG); TB = LET(TB * AG)
        # 310 MA = 143.5:MB = 95.8:IA = 3728:IB = 1961: REM VEHICLE INERTIAL PROPERTIES
        MA = LET(DATA("MA")); MB = LET(DATA("MB")); IA = LET(DATA("IA")); IB = LET(DATA("IB"))
        # 320 KI = (MA * (UX ^ 2 + UY ^ 2) + MB * (VX ^ 2 + VY ^ 2) + IA * (WA ^ 2) + IB * (WB ^ 2)) / 2
        KI = LET((MA * (UX**2 + UY**2) + MB * (VX**2 + VY**2) + IA * (WA**2) + IB * (WB**2)) / 2)
        # 330 D1 = DB * SIN (TB + PB):D2 = DB * COS (TB + PB):D3 = DA * SIN (TA + PA):D4 = DA * COS (TA + PA)
        D1 = LET(DB * SIN(TB + PB)); D2 = LET(DB * COS(TB + PB)); D3 = LET(DA * SIN(TA + PA)); D4 = LET(DA * COS(TA + PA))
        # 340 XA = UX + D3 * WA:YA = UY - D4 * WA:XB = VX - D1 * WB:YB = VY + D2 * WB
        XA = LET(UX + D3 * WA); YA = LET(UY - D4 * WA); XB = LET(VX - D1 * WB); YB = LET(VY + D2 * WB)
        # 350 N = 6:M = 6: REM SETTING M = 4 WILL PROVIDE A POINT-MASS SOLUTION (NO ROTATIONAL EFFECTS)
        N = LET(C_6); M = LET(DATA("M"))
        # 360 DIM A(N,N + 1),B(N,N + 1),BR(6)
        A = DIM(N, N + 1); B = DIM(N, N + 1); BR = DIM(6)
        # 370 A(1,1) = MA:A(1,3) = MB:A(1,2) = 0:A(1,4) = 0:A(1,5) = 0:A(1,6) = 0
        A[1, 1] = MA; A[1, 3] = MB; A[1, 2] = ZERO; A[1, 4] = ZERO; A[1, 5] = ZERO; A[1, 6] = ZERO
        # 380 A(2,2) = MA:A(2,4) = MB:A(2,1) = 0:A(2,3) = 0:A(2,5) = 0:A(2,6) = 0
        A[2, 2] = MA; A[2, 4] = MB; A[2, 1] = ZERO; A[2, 3] = ZERO; A[2, 5] = ZERO; A[2, 6] = ZERO
        # 390 IF MU = -10 THEN 430
        if not MU == -C_10:
            # 400 IF (XA * SIN (GA) - YA * COS (GA)) < (XB * SIN (GA) - YB * COS (GA)) THEN MU = -MU
            if (XA * SIN(GA) - YA * COS(GA)) < (XB * SIN(GA) - YB * COS(GA)):
                MU = LET(-MU)
            # 410 A(3,2) = MA * (COS (GA) - MU * SIN (GA)):A(3,3) = MB * (SIN (GA) + MU * COS (GA)):A(3,1) = 0:A(3,4) = 0:A(3,5) = 0:A(3,6) = 0
            A[3, 2] = MA * (COS(GA) - MU * SIN(GA)); A[3, 3] = MB * (SIN(GA) + MU * COS(GA)); A[3, 1] = ZERO; A[3, 4] = ZERO; A[3, 5] = ZERO; A[3, 6] = ZERO
        # 420 GOTO 450
        else:
            # 430 A(3,1) = SIN (GA):A(3,2) = -COS (GA):A(3,3) = -A(3,1):A(3,4) = -A(3,2)
            A[3, 1] = SIN(GA); A[3, 2] = -COS(GA); A[3, 3] = -A[3, 1]; A[3, 4] = -A[3, 2]
            # 440 A(3,5) = DA * COS (PA + TA - GA):A(3,6) = DB * COS (PB + TB - GA)
            A[3, 5] = DA * COS(PA + TA - GA); A[3, 6] = DB * COS(PB + TB - GA)
        # 450 A(4,1) = COS (GA):A(4,2) = SIN (GA):A(4,3) = -A(4,1):A(4,4) = -A(4,2)
        A[4, 1] = COS(GA); A[4, 2] = SIN(GA); A[4, 3] = -A[4, 1]; A[4, 4] = -A[4, 2]
        # 460 A(4,5) = D3 * COS (GA) - D4 * SIN (GA):A(4,6) = D1 * COS (GA) - D2 * SIN (GA)
        A[4, 5] = D3 * COS(GA) - D4 * SIN(GA); A[4, 6] = D1 * COS(GA) - D2 * SIN(GA)
        # 470 A(5,2) = MA * (D2 + D4):A(5,3) = MB * (D1 + D3):A(5,5) = IA:A(5,6) = IB:A(5,1) = 0:A(5,4) = 0
        A[5, 2] = MA * (D2 + D4); A[5, 3] = MB * (D1 + D3); A[5, 5] = IA; A[5, 6] = IB; A[5, 1] = ZERO; A[5, 4] = ZERO
        # 480 A(6,1) = -EM * MA * D3 / IA:A(6,2) = EM * MA * D4 / IA:A(6,3) = -EM * MB * D1 / IB:A(6,4) = EM * MB * D2 / IB
        A[6, 1] = -EM * MA * D3 / IA; A[6, 2] = EM * MA * D4 / IA; A[6, 3] = -EM * MB * D1 / IB; A[6, 4] = EM * MB * D2 / IB
        # 490 A(6,5) = 2 * EM - 1:A(6,6) = 1 - 2 * EM
        A[6, 5] = 2 * EM - 1; A[6, 6] = 1 - 2 * EM
        # 500 A(1,M + 1) = MA * UX + MB * VX:A(2,M + 1) = MA * UY + MB * VY
        A[1, M + 1] = MA * UX + MB * VX; A[2, M + 1] = MA * UY + MB * VY
        # 510 IF MU > -10 THEN 530
        if not MU > -C_10:
            # 520 A(3,M + 1) = 0: GOTO 540
            A[3, M + 1] = ZERO
        else:
            # 530 A(3,M + 1) = MA * (COS (GA) - MU * SIN (GA)) * UY + MB * (SIN (GA) + MU * COS (GA)) * VX
            A[3, M + 1] = MA * (COS(GA) - MU * SIN(GA)) * UY + MB * (SIN(GA) + MU * COS(GA)) * VX
        # 540 A(4,M + 1) = -E * ((UY - D4 * WA - VY - D2 * WB) * SIN (GA) + (UX + D3 * WA - VX + D1 * WB) * COS (GA))
        A[4, M + 1] = -E * ((UY - D4 * WA - VY - D2 * WB) * SIN(GA) + (UX + D3 * WA - VX + D1 * WB) * COS(GA))
        # 550 A(5,M + 1) = MA * (D2 + D4) * UY + MB * (D1 + D3) * VX + IA * WA + IB * WB
        A[5, M + 1] = MA * (D2 + D4) * UY + MB * (D1 + D3) * VX + IA * WA + IB * WB
        # 560 A(6,M + 1) = EM * (-MA * D3 * UX / IA + MA * D4 * UY / IA - MB * D1 * VX / IB + MB * D2 * VY / IB + WA - WB)
        A[6, M + 1] = EM * (-MA * D3 * UX / IA + MA * D4 * UY / IA - MB * D1 * VX / IB + MB * D2 * VY / IB + WA - WB)
        # 570 GOSUB 1000
        gosub_1000()
        # 580 KF = (MA * (A(1,M + 1) ^ 2 + A(2,M + 1) ^ 2) + MB * (A(3,M + 1) ^ 2 + A(4,M + 1) ^ 2)) / 2
        KF = LET((MA * (A[1, M + 1] ** 2 + A[2, M + 1] ** 2) + MB * (A[3, M + 1] ** 2 + A[4, M + 1] ** 2)) / 2)
        # 590 IF N = M THEN KF = KF + (IA * A(5,M + 1) ^ 2 + IB * A(6,M + 1) ^ 2) / 2
        if N == M:
            KF = LET(KF + (IA * A[5, M + 1] ** 2 + IB * A[6, M + 1] ** 2) / 2)
        # 600 TA = TA / AG:TB = TB / AG:PA = PA / AG:PB = PB / AG:GA = GA / AG
        TA = LET(TA / AG); TB = LET(TB / AG); PA = LET(PA / AG); PB = LET(PB / AG); GA = LET(GA / AG)
        # 610 PRINT CHR$(140): PRINT CHR$(4);P$
        PRINT << CHR(140) << NL; PRINT << CHR(4) << P_ << NL
        # 620 PRINT : PRINT : PRINT "MA= ";MA;" MB= ";MB;" IA= ";IA;" IB= ";IB
        PRINT << NL; PRINT << NL; PRINT << "MA= " << MA << " MB= " << MB << " IA= " << IA << " IB= " << IB << NL
        # 630 PRINT : PRINT "DA= ";DA;" DB= ";DB
        PRINT << NL; PRINT << "DA= " << DA << " DB= " << DB << NL
        # 640 PRINT : PRINT " PA PB TA TB GA"
        PRINT << NL; PRINT << " PA PB TA TB GA" << NL
        # 650 PRINT " ";PA"      ";PB"      ";TA;"      ";TB"      ";GA
        PRINT << " " << PA << "      " << PB << "      " << TA << "      " << TB << "      " << GA << NL
        # 660 PRINT : PRINT "UX= ";UX;" UY= ";UY;" WA= ";WA;" XA= "; INT (100 * XA) / 100;" YA= "; INT (100 * YA) / 100
        PRINT << NL; PRINT << "UX= " << UX << " UY= " << UY << " WA= " << WA << " XA= " << INT(100 * XA) / 100 << " YA= " << INT(100 * YA) / 100 << NL
        # 670 PRINT : PRINT "VX= ";VX;" VY= ";VY;" WB= ";WB;" XB= "; INT (100 * XB) / 100;" YB= "; INT (100 * YB) / 100
        PRINT << NL; PRINT << "VX= " << VX << " VY= " << VY << " WB= " << WB << " XB= " << INT(100 * XB) / 100 << " YB= " << INT(100 * YB) / 100 << NL
        # 680 PRINT : PRINT " E= ";E;" MU= ";MU;" EM= ";EM
        PRINT << NL; PRINT << " E= " << E << " MU= " << MU << " EM= " << EM << NL
        # 690 PRINT : PRINT "INITIAL KE= ";KI;" KE LOSS= ";( INT (1E4 * (KI - KF) / KI)) / 100;" %"
        PRINT << NL; PRINT << "INITIAL KE= " << KI << " KE LOSS= " << (INT(C_1E4 * (KI - KF) / KI)) / 100 << " %" << NL
        # 700 XA = A(1,M + 1) + D3 * A(5,M + 1):YA = A(2,M + 1) - D4 * A(5,M + 1)
        XA = LET(A[1, M + 1] + D3 * A[5, M + 1]); YA = LET(A[2, M + 1] - D4 * A[5, M + 1])
        # 710 XB = A(3,M + 1) - D1 * A(6,M + 1):YB = A(4,M + 1) + D2 * A(6,M + 1)
        XB = LET(A[3, M + 1] - D1 * A[6, M + 1]); YB = LET(A[4, M + 1] + D2 * A[6, M + 1])
        # 720 PRINT : PRINT "*****"
        PRINT << NL; PRINT << "*****" << NL
        # 730 PRINT : PRINT "VAX= "; INT (1E3 * A(1,M + 1)) / 1E3;" VAY= "; INT (1E3 * A(2,M + 1)) / 1E3;" (XA="; INT (100 * XA) / 100;" YA= "; INT (100 * YA) / 100;")"
        PRINT << NL; PRINT << "VAX= " << INT(C_1E3 * A[1, M + 1]) / C_1E3 << " VAY= " << INT(C_1E3 * A[2, M + 1]) / C_1E3 << " (XA=" << INT(100 * XA) / 100 << " YA= " << INT(100 * YA) / 100 << ")" << NL
        # 740 PRINT : PRINT "VBX= "; INT (1E3 * A(3,M + 1)) / 1E3;" VBY= "; INT (1E3 * A(4,M + 1)) / 1E3;" (XB="; INT (100 * XB) / 100;" YB= "; INT (100 * YB) / 100;")"
        PRINT << NL; PRINT << "VBX= " << INT(C_1E3 * A[3, M + 1]) / C_1E3 << " VBY= " << INT(C_1E3 * A[4, M + 1]) / C_1E3 << " (XB=" << INT(100 * XB) / 100 << " YB= " << INT(100 * YB) / 100 << ")" << NL
        # 750 IF M < > N THEN 770
        if not M != N:
            # 760 PRINT : PRINT " WA= "; INT (10000 * A(5,M + 1)) / 10000;" WB= "; INT (10000 * A(6,M + 1)) / 10000
            PRINT << NL; PRINT << " WA= " << INT(10000 * A[5, M + 1]) / 10000 << " WB= " << INT(10000 * A[6, M + 1]) / 10000 << NL
        # 770 PRINT : PRINT "*****"
        PRINT << NL; PRINT << "*****" << NL
        # 780 PRINT CHR$(4)"PR#0": END
        PRINT << CHR(4) << "PR#0" << NL
        return

    def gosub_1000() -> None:
        nonlocal J, I, CO, RO, AR
        # 1000 REM SUB TO SOLVE SIMULTANEOUS EQUATIONS BY PIVOTAL ELIMINATION (TODD, P234)
        # 1010 FOR J = 1 TO M:I = J: GOSUB 1070
        J = LET(C_1)
        while True:
            I = LET(J); gosub_1070()
            # 1020 FOR RO = 1 TO M: IF RO = I THEN 1060
            RO = LET(C_1)
            while True:
                if not RO == I:
                    # 1030 AR = A(RO,J)
                    AR = LET(A[RO, J])
                    # 1040 FOR CO = J TO M + 1:A(RO,CO) = A(RO,CO) - A(I,CO) * AR
                    CO = LET(J); limit = LET(M + 1)
                    while True:
                        A[RO, CO] = A[RO, CO] - A[I, CO] * AR
                        # 1050 NEXT CO
                        CO = NEXT(CO)
                        if CO > limit:
                            break
                # 1060 NEXT RO: NEXT J: RETURN
                RO = NEXT(RO)
                if RO > M:
                    break
            J = NEXT(J)
            if J > M:
                break
        return

    def gosub_1070() -> None:
        nonlocal MX, CO, RO, RX, AP, OL, AS
        # 1070 REM SUB TO FIND MAX PIVOT & CHANGE ROWS
        # 1080 MX = 1E - 9:CO = J: FOR RO = I TO M
        MX = LET(C_1E_9); CO = LET(J); RO = LET(I)
        while True:
            # 1090 IF ABS (MX) > ABS (A(RO,CO)) AND RO * CO < (M * M) THEN 1110
            if not (ABS(MX) > ABS(A[RO, CO]) and RO * CO < (M * M)):
                # 1100 MX = A(RO,CO):RX = RO
                MX = LET(A[RO, CO]); RX = LET(RO)
            # 1110 NEXT RO
            RO = NEXT(RO)
            if RO > M:
                break
        # 1120 IF ABS (A(RX,J)) < 1E - 9 THEN 1160
        if not ABS(A[RX, J]) < C_1E_9:
            # 1130 AP = A(RX,J): FOR OL = J TO M + 1
            AP = LET(A[RX, J]); OL = LET(J); limit = LET(M + 1)
            while True:
                # 1140 AS = A(I,OL):A(I,OL) = A(RX,OL):A(RX,OL) = AS
                AS = LET(A[I, OL]); A[I, OL] = A[RX, OL]; A[RX, OL] = AS
                # 1150 A(I,OL) = A(I,OL) / AP: NEXT OL: RETURN
                A[I, OL] = A[I, OL] / AP; OL = NEXT(OL)
                if OL > limit:
                    break
            return
        # 1160 PRINT : PRINT "ZERO DETERMINANT": END
        PRINT << NL; PRINT << "ZERO DETERMINANT" << NL
        raise End
        # 1170 RETURN

    main()
    return locals()
