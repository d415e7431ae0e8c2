/* Made from the formulas of closedform/impact.py by mechanics/loops.py: not to be edited. */

#define FORMULAS "a14c68646dac0027"
enum column { AT_E, AT_MU, AT_EM, AT_DA, AT_DB, AT_GA, AT_PA, AT_PB, AT_TA, AT_TB, AT_MA, AT_MB,
    AT_IA, AT_IB, AT_UX, AT_UY, AT_WA, AT_VX, AT_VY, AT_WB, AT_M, COLUMNS };
enum kind { FRICTION, PIVOT, POINT, POINT_PIVOT, KINDS };
enum result { TO_VAX, TO_VAY, TO_VBX, TO_VBY, TO_WAF, TO_WBF, TO_XA, TO_YA, TO_XB, TO_YB, TO_XAF,
    TO_YAF, TO_XBF, TO_YBF, TO_VC, TO_VS, TO_KI, TO_KF, TO_LOSS, TO_ELN, TO_ELT, TO_ELM, TO_EESA,
    TO_EESB, TO_DVA, TO_DVB, TO_PN, TO_PT, TO_PM, TO_MUP, TO_MUC, TO_COND, TO_STATUS, TO_gn, TO_gt,
    TO_determinant, TO_critical_denominator, RESULTS };
#define NAMES_OF_RESULTS \
    "VAX VAY VBX VBY WAF WBF XA YA XB YB XAF YAF XBF YBF VC VS KI KF LOSS ELN ELT ELM EESA EESB " \
    "DVA DVB PN PT PM MUP MUC COND STATUS gn gt determinant critical_denominator"
enum { ROWS = 130, CONSTANTS = 2 };
/* Where a result is: a column, a row, or a constant. */
enum { ROW = COLUMNS, CONSTANT = ROW + ROWS };
static const double constants[] = {-10.0, 0.0};
static const loop_set sines_of_arms = {{0x4230, 0x0}};
static const int rows_of_arms[] = {9, 10, 6, 11, 24, 25, 31, 32};
static const loop_set loops_of[KINDS][RESULTS] = {
    [FRICTION] = {
        {{0x7e1001ff, 0x0}}, {{0x3e1001ff, 0x0}}, {{0x7e1001ff, 0x0}}, {{0x3e1001ff, 0x0}},
        {{0x18e0001ff, 0x0}}, {{0x18e0001ff, 0x0}}, {{0xe02, 0x0}}, {{0x3602, 0x0}},
        {{0x3c002, 0x0}}, {{0xcc002, 0x0}}, {{0x60007fe10c7ff, 0x0}}, {{0xa0007be10c7ff, 0x0}},
        {{0x60007fe10c7ff, 0x0}}, {{0xa0007be10c7ff, 0x0}}, {{0x2000f7, 0x0}},
        {{0x40000000f7, 0x0}}, {{0xc00000, 0x0}}, {{0x80001fed001ff, 0x0}}, {{0x1e1fc001ff, 0x0}},
        {{0x301f0001ff, 0x0}}, {{0x461e0001ff, 0x0}}, {{0x4a0e0001ff, 0x0}},
        {{0xc00001e1f0001ff, 0x0}}, {{0xc00001e1f0001ff, 0x0}}, {{0x803e0001ff, 0x0}},
        {{0x1003e0001ff, 0x0}}, {{0x1e0001ff, 0x0}}, {{0x21e0001ff, 0x0}}, {{0xa0e0001ff, 0x0}},
        {{0x1bf, 0x0}}, {{0x3c000605de07, 0x0}}, {{0x80002020e0001bf, 0x0}},
        {{0x1c023e1fffd5dfff, 0x0}}, {{0xf7, 0x0}}, {{0xbf, 0x0}}, {{0xe0001bf, 0x0}},
        {{0x3c000605de07, 0x0}}
    },
    [PIVOT] = {
        {{0xcc000605de07, 0x0}}, {{0xcc000605de07, 0x0}}, {{0xcc000605de07, 0x0}},
        {{0xcc000605de07, 0x0}}, {{0x10c008605de07, 0x0}}, {{0x10c008605de07, 0x0}}, {{0xe02, 0x0}},
        {{0x3602, 0x0}}, {{0x3c002, 0x0}}, {{0xcc002, 0x0}}, {{0x13cc008605def7, 0x0}},
        {{0x23cc008605def7, 0x0}}, {{0x13cc008605def7, 0x0}}, {{0x23cc008605def7, 0x0}},
        {{0x2000f7, 0x0}}, {{0x40000000f7, 0x0}}, {{0xc00000, 0x0}}, {{0x2001cc0086c5de07, 0x0}},
        {{0x21c1dc0087c5deff, 0x0}}, {{0x801c000705def7, 0x0}}, {{0x801c000605debf, 0x0}},
        {{0x1401c000605de07, 0x0}}, {{0x25c1dc008785deff, 0x0}}, {{0x25c1dc008785deff, 0x0}},
        {{0x801c000605de07, 0x0}}, {{0x801c000605de07, 0x0}}, {{0x801c000605de07, 0x0}},
        {{0x801c000605de07, 0x0}}, {{0x401c000605de07, 0x0}}, {{0x0, 0x0}}, {{0x3c000605de07, 0x0}},
        {{0x20006020600c6b6, 0x0}}, {{0x47c3de0287c5deff, 0x0}}, {{0xf7, 0x0}}, {{0xbf, 0x0}},
        {{0x4000600c602, 0x0}}, {{0x3c000605de07, 0x0}}
    },
    [POINT] = {
        {{0x800000000210004d, 0xb8}}, {{0x800000000210004d, 0x60078}}, {{0x800000000210004d, 0xb8}},
        {{0x800000000210004d, 0x60078}}, {{0x0, 0x0}}, {{0x0, 0x0}}, {{0x0, 0x0}}, {{0x0, 0x0}},
        {{0x0, 0x0}}, {{0x0, 0x0}}, {{0x800000000210004d, 0xb8}}, {{0x800000000210004d, 0x60078}},
        {{0x800000000210004d, 0xb8}}, {{0x800000000210004d, 0x60078}}, {{0x45, 0x1}}, {{0x45, 0x8}},
        {{0x400000, 0x2}}, {{0x800000000250004d, 0x1600f8}}, {{0x800000000340004d, 0xf1a}},
        {{0x3000045, 0x1118}}, {{0x800000000200004d, 0x4618}}, {{0x0, 0x0}},
        {{0x840000000300004d, 0x6718}}, {{0x840000000300004d, 0xa718}},
        {{0x800000000200004d, 0x10078}}, {{0x800000000200004d, 0x20038}}, {{0x2000045, 0x18}},
        {{0x800000000200004d, 0x218}}, {{0x0, 0x0}}, {{0x800000000000000d, 0x0}},
        {{0x2000045, 0x1e00008}}, {{0x800000000200000d, 0x8000c}},
        {{0x840000000350004d, 0x3fe27fe}}, {{0x45, 0x0}}, {{0xd, 0x0}}, {{0x2000000, 0x0}},
        {{0x2000045, 0xe00008}}
    },
    [POINT_PIVOT] = {
        {{0x400002000045, 0x4200008}}, {{0x400002000045, 0x8200008}}, {{0x400002000045, 0x4200008}},
        {{0x400002000045, 0x8200008}}, {{0x0, 0x0}}, {{0x0, 0x0}}, {{0x0, 0x0}}, {{0x0, 0x0}},
        {{0x0, 0x0}}, {{0x0, 0x0}}, {{0x400002000045, 0x4200008}}, {{0x400002000045, 0x8200008}},
        {{0x400002000045, 0x4200008}}, {{0x400002000045, 0x8200008}}, {{0x45, 0x1}}, {{0x45, 0x8}},
        {{0x400000, 0x2}}, {{0x400002400045, 0x1c200008}}, {{0x40000340004d, 0x2ec60010a}},
        {{0x3000045, 0x160600108}}, {{0x200004d, 0x1a0600008}}, {{0x0, 0x0}},
        {{0x40040000300004d, 0x2ec600108}}, {{0x40040000300004d, 0x2ec600108}},
        {{0x2000045, 0x420600008}}, {{0x2000045, 0x820600008}}, {{0x2000045, 0x60600008}},
        {{0x2000045, 0xa0600008}}, {{0x0, 0x0}}, {{0x0, 0x0}}, {{0x2000045, 0x1e00008}},
        {{0x2000000, 0x100000000c}}, {{0x40040000340004d, 0x32ec70010e}}, {{0x45, 0x0}},
        {{0xd, 0x0}}, {{0x2000000, 0x0}}, {{0x2000045, 0xe00008}}
    },
};
static const int place_of[KINDS][RESULTS] = {
    [FRICTION] = {
        ROW + 88, ROW + 98, ROW + 93, ROW + 99, ROW + 62, ROW + 67, ROW + 28, ROW + 30, ROW + 35,
        ROW + 37, ROW + 19, ROW + 22, ROW + 20, ROW + 56, ROW + 41, ROW + 78, ROW + 49, ROW + 57,
        ROW + 84, ROW + 85, ROW + 91, ROW + 95, ROW + 3, ROW + 26, ROW + 81, ROW + 65, ROW + 92, ROW
        + 77, ROW + 76, ROW + 23, ROW + 109, ROW + 29, ROW + 33, ROW + 21, ROW + 16, ROW + 83, ROW +
        69
    },
    [PIVOT] = {
        ROW + 62, ROW + 65, ROW + 67, ROW + 74, ROW + 56, ROW + 57, ROW + 28, ROW + 30, ROW + 35,
        ROW + 37, ROW + 19, ROW + 22, ROW + 20, ROW + 68, ROW + 41, ROW + 78, ROW + 49, ROW + 14,
        ROW + 15, ROW + 72, ROW + 73, ROW + 79, ROW + 17, ROW + 18, ROW + 75, ROW + 76, ROW + 33,
        ROW + 70, ROW + 3, CONSTANT + 0, ROW + 109, ROW + 2, ROW + 26, ROW + 21, ROW + 16, ROW +
        123, ROW + 69
    },
    [POINT] = {
        ROW + 26, ROW + 22, ROW + 27, ROW + 24, AT_WA, AT_WB, AT_UX, AT_UY, AT_VX, AT_VY, ROW + 26,
        ROW + 22, ROW + 27, ROW + 24, ROW + 3, ROW + 11, ROW + 6, ROW + 19, ROW + 15, ROW + 31, ROW
        + 34, CONSTANT + 1, ROW + 35, ROW + 29, ROW + 32, ROW + 33, ROW + 16, ROW + 28, CONSTANT +
        1, ROW + 2, ROW + 50, ROW + 18, ROW + 23, ROW + 13, ROW + 8, ROW + 54, ROW + 48
    },
    [POINT_PIVOT] = {
        ROW + 2, ROW + 15, ROW + 7, ROW + 16, AT_WA, AT_WB, AT_UX, AT_UY, AT_VX, AT_VY, ROW + 2, ROW
        + 15, ROW + 7, ROW + 16, ROW + 3, ROW + 11, ROW + 6, ROW + 17, ROW + 30, ROW + 26, ROW + 27,
        CONSTANT + 1, ROW + 31, ROW + 32, ROW + 4, ROW + 5, ROW + 10, ROW + 12, CONSTANT + 1,
        CONSTANT + 0, ROW + 50, ROW + 18, ROW + 9, ROW + 13, ROW + 8, ROW + 54, ROW + 48
    },
};

/* The results of a strip of scenes, as far as ``loops`` are done. */
static CLONES void compute_loops(
    const double *const *in, const double *const *ahead,
    double (*restrict v)[ROW_LENGTH], const circle *circle, const loop_set loops,
    const int64_t eights)
{
    const int64_t lanes = 8 * eights; /* vectors of any length leave no rest */
    COLUMN(E) COLUMN(MU) COLUMN(EM) COLUMN(DA) COLUMN(DB) COLUMN(GA) COLUMN(PA) COLUMN(PB)
    COLUMN(TA) COLUMN(TB) COLUMN(MA) COLUMN(MB) COLUMN(IA) COLUMN(IB) COLUMN(UX) COLUMN(UY)
    COLUMN(WA) COLUMN(VX) COLUMN(VY) COLUMN(WB)
    if (HAS(loops, 0)) EACH SINE_AND_COSINE(GA[i], v[1][i], v[0][i]);
    if (HAS(loops, 1)) EACH {
        double x0 = ADD(TA[i], PA[i]); v[2][i] = x0;
        double x1 = ADD(TB[i], PB[i]); v[3][i] = x1;
    }
    if (HAS(loops, 1)) { FETCH_COLUMN(PA) FETCH_COLUMN(PB) FETCH_COLUMN(TA) FETCH_COLUMN(TB) }
    if (HAS(loops, 2)) EACH {
        double x0 = SUBTRACT(UY[i], VY[i]); v[4][i] = x0;
        double x1 = SUBTRACT(UX[i], VX[i]); v[5][i] = x1;
        double x2 = SUBTRACT(v[2][i], GA[i]); v[6][i] = x2;
        double x3 = SUBTRACT(v[3][i], GA[i]); v[7][i] = x3;
    }
    if (HAS(loops, 2)) { FETCH_COLUMN(GA) FETCH_COLUMN(UX) FETCH_COLUMN(UY) FETCH_COLUMN(VX) FETCH_COLUMN(VY) }
    if (HAS(loops, 3)) EACH {
        double x0 = MULTIPLY(v[0][i], v[4][i]);
        double x1 = MULTIPLY(v[1][i], v[5][i]);
        double x2 = SUBTRACT(x0, x1); v[8][i] = x2;
    }
    if (HAS(loops, 4)) EACH SINE_AND_COSINE(v[6][i], v[10][i], v[9][i]);
    if (HAS(loops, 5)) EACH SINE_AND_COSINE(v[7][i], v[11][i], v[6][i]);
    if (HAS(loops, 6)) EACH {
        double x0 = MULTIPLY(v[0][i], v[5][i]); v[7][i] = x0;
        double x1 = MULTIPLY(v[1][i], v[4][i]); v[12][i] = x1;
        double x2 = ADD(x0, x1); v[13][i] = x2;
    }
    if (HAS(loops, 7)) EACH {
        double x0 = MULTIPLY(DA[i], v[9][i]); v[14][i] = x0;
        double x1 = MULTIPLY(x0, WA[i]);
        double x2 = SUBTRACT(v[8][i], x1);
        double x3 = MULTIPLY(DB[i], v[6][i]); v[15][i] = x3;
        double x4 = MULTIPLY(x3, WB[i]);
        double x5 = SUBTRACT(x2, x4); v[16][i] = x5;
        double x6 = MULTIPLY(DA[i], v[10][i]); v[17][i] = x6;
        double x7 = MULTIPLY(DB[i], v[11][i]); v[18][i] = x7;
        double x8 = MULTIPLY(x6, WA[i]); v[19][i] = x8;
        double x9 = ADD(v[13][i], x8);
        double x10 = MULTIPLY(x7, WB[i]); v[20][i] = x10;
        double x11 = ADD(x9, x10); v[21][i] = x11;
        double x12 = MULTIPLY(E[i], x11); v[22][i] = x12;
    }
    if (HAS(loops, 7)) { FETCH_COLUMN(E) FETCH_COLUMN(DA) FETCH_COLUMN(DB) }
    if (HAS(loops, 8)) EACH {
        double x0 = AGAINST(MU[i], v[16][i]); v[23][i] = x0;
    }
    if (HAS(loops, 8)) { FETCH_COLUMN(MU) }
    if (HAS(loops, 9)) EACH SINE_AND_COSINE(v[2][i], v[24][i], v[25][i]);
    if (HAS(loops, 10)) EACH {
        double x0 = MULTIPLY(DA[i], v[24][i]); v[2][i] = x0;
        double x1 = MULTIPLY(DA[i], v[25][i]); v[26][i] = x1;
    }
    if (HAS(loops, 11)) EACH {
        double x0 = MULTIPLY(v[2][i], WA[i]); v[27][i] = x0;
        double x1 = ADD(UX[i], x0); v[28][i] = x1;
    }
    if (HAS(loops, 12)) EACH {
        double x0 = MULTIPLY(v[26][i], WA[i]); v[29][i] = x0;
    }
    if (HAS(loops, 13)) EACH {
        double x0 = SUBTRACT(UY[i], v[29][i]); v[30][i] = x0;
    }
    if (HAS(loops, 14)) EACH SINE_AND_COSINE(v[3][i], v[31][i], v[32][i]);
    if (HAS(loops, 15)) EACH {
        double x0 = MULTIPLY(DB[i], v[31][i]); v[3][i] = x0;
        double x1 = MULTIPLY(DB[i], v[32][i]); v[33][i] = x1;
    }
    if (HAS(loops, 16)) EACH {
        double x0 = MULTIPLY(v[3][i], WB[i]); v[34][i] = x0;
    }
    if (HAS(loops, 17)) EACH {
        double x0 = SUBTRACT(VX[i], v[34][i]); v[35][i] = x0;
    }
    if (HAS(loops, 18)) EACH {
        double x0 = MULTIPLY(v[33][i], WB[i]); v[36][i] = x0;
    }
    if (HAS(loops, 19)) EACH {
        double x0 = ADD(VY[i], v[36][i]); v[37][i] = x0;
    }
    if (HAS(loops, 20)) EACH {
        double x0 = MULTIPLY(0x1.5555555555555p-1, MA[i]); v[38][i] = x0;
        double x1 = MULTIPLY(0x1.5555555555555p-1, MB[i]); v[39][i] = x1;
        double x2 = ABSOLUTE(v[8][i]); v[40][i] = x2;
    }
    if (HAS(loops, 21)) EACH {
        double x0 = NEGATIVE(v[21][i]); v[41][i] = x0;
    }
    if (HAS(loops, 22)) EACH {
        double x0 = MINIMUM(MA[i], 0x1.fffffffffffffp+1023); v[42][i] = x0;
        double x1 = MULTIPLY(UX[i], UX[i]);
        double x2 = MULTIPLY(UY[i], UY[i]);
        double x3 = ADD(x1, x2);
        double x4 = MULTIPLY(x0, x3);
        double x5 = MINIMUM(MB[i], 0x1.fffffffffffffp+1023); v[43][i] = x5;
        double x6 = MULTIPLY(VX[i], VX[i]);
        double x7 = MULTIPLY(VY[i], VY[i]);
        double x8 = ADD(x6, x7);
        double x9 = MULTIPLY(x5, x8);
        double x10 = ADD(x4, x9); v[44][i] = x10;
    }
    if (HAS(loops, 23)) EACH {
        double x0 = MINIMUM(IA[i], 0x1.fffffffffffffp+1023); v[45][i] = x0;
        double x1 = MULTIPLY(WA[i], WA[i]); v[46][i] = x1;
        double x2 = MULTIPLY(x0, x1);
        double x3 = ADD(v[44][i], x2);
        double x4 = MINIMUM(IB[i], 0x1.fffffffffffffp+1023); v[47][i] = x4;
        double x5 = MULTIPLY(WB[i], WB[i]); v[48][i] = x5;
        double x6 = MULTIPLY(x4, x5);
        double x7 = ADD(x3, x6);
        double x8 = MULTIPLY(0x1.0000000000000p-1, x7); v[49][i] = x8;
    }
    if (HAS(loops, 24)) EACH {
        double x0 = SUBTRACT(0x1.0000000000000p+0, E[i]); v[50][i] = x0;
        double x1 = MULTIPLY(x0, v[21][i]); v[51][i] = x1;
    }
    if (HAS(loops, 25)) EACH {
        double x0 = DIVIDE(0x1.0000000000000p+0, MA[i]); v[52][i] = x0;
        double x1 = DIVIDE(0x1.0000000000000p+0, MB[i]); v[53][i] = x1;
        double x2 = ADD(x0, x1); v[54][i] = x2;
        double x3 = DIVIDE(0x1.0000000000000p+0, x2); v[55][i] = x3;
    }
    if (HAS(loops, 25)) { FETCH_COLUMN(MA) FETCH_COLUMN(MB) }
    if (HAS(loops, 26)) EACH {
        double x0 = ADD(EM[i], EM[i]);
        double x1 = SUBTRACT(0x1.0000000000000p+0, x0); v[56][i] = x1;
        double x2 = MULTIPLY(x1, v[54][i]); v[57][i] = x2;
        double x3 = DIVIDE(0x1.0000000000000p+0, IA[i]); v[58][i] = x3;
        double x4 = DIVIDE(0x1.0000000000000p+0, IB[i]); v[59][i] = x4;
        double x5 = ADD(x3, x4); v[60][i] = x5;
        double x6 = DIVIDE(0x1.0000000000000p+0, x5); v[61][i] = x6;
        double x7 = MULTIPLY(x4, x6); v[62][i] = x7;
        double x8 = MULTIPLY(x3, x7); v[63][i] = x8;
        double x9 = SUBTRACT(WA[i], WB[i]); v[64][i] = x9;
        double x10 = MULTIPLY(x6, x9); v[65][i] = x10;
        double x11 = MULTIPLY(x7, WA[i]); v[66][i] = x11;
        double x12 = MULTIPLY(x3, x6); v[67][i] = x12;
        double x13 = MULTIPLY(x12, WB[i]); v[68][i] = x13;
        double x14 = ADD(x11, x13); v[69][i] = x14;
        double x15 = SUBTRACT(0x1.0000000000000p+0, EM[i]); v[70][i] = x15;
        double x16 = MULTIPLY(x3, WB[i]); v[71][i] = x16;
        double x17 = MULTIPLY(x4, WA[i]); v[72][i] = x17;
        double x18 = MULTIPLY(x10, v[54][i]); v[73][i] = x18;
    }
    if (HAS(loops, 26)) { FETCH_COLUMN(EM) FETCH_COLUMN(IA) FETCH_COLUMN(IB) FETCH_COLUMN(WA) FETCH_COLUMN(WB) }
    if (HAS(loops, 27)) EACH {
        double x0 = MULTIPLY(v[23][i], v[14][i]);
        double x1 = SUBTRACT(v[17][i], x0); v[74][i] = x1;
        double x2 = MULTIPLY(v[23][i], v[15][i]);
        double x3 = SUBTRACT(v[18][i], x2); v[75][i] = x3;
        double x4 = ADD(x1, x3);
        double x5 = MULTIPLY(v[63][i], x4); v[76][i] = x5;
        double x6 = MULTIPLY(v[56][i], x5); v[77][i] = x6;
        double x7 = ADD(v[17][i], v[18][i]); v[78][i] = x7;
        double x8 = MULTIPLY(x6, x7);
        double x9 = MULTIPLY(x1, v[58][i]);
        double x10 = MULTIPLY(x3, v[59][i]);
        double x11 = SUBTRACT(x9, x10);
        double x12 = MULTIPLY(v[61][i], x11); v[79][i] = x12;
        double x13 = MULTIPLY(EM[i], x12); v[80][i] = x13;
        double x14 = MULTIPLY(v[17][i], v[58][i]);
        double x15 = MULTIPLY(v[18][i], v[59][i]);
        double x16 = SUBTRACT(x14, x15); v[81][i] = x16;
        double x17 = MULTIPLY(x13, x16);
        double x18 = SUBTRACT(x8, x17); v[82][i] = x18;
        double x19 = ADD(v[57][i], x18); v[83][i] = x19;
        double x20 = DIVIDE(0x1.0000000000000p+0, x19); v[84][i] = x20;
        double x21 = ADD(v[22][i], v[13][i]); v[85][i] = x21;
    }
    if (HAS(loops, 28)) EACH {
        double x0 = MULTIPLY(v[1][i], v[23][i]);
        double x1 = SUBTRACT(v[0][i], x0); v[86][i] = x1;
        double x2 = MULTIPLY(v[0][i], x1); v[87][i] = x2;
        double x3 = MULTIPLY(v[0][i], v[23][i]);
        double x4 = ADD(v[1][i], x3); v[88][i] = x4;
        double x5 = MULTIPLY(v[1][i], x4); v[89][i] = x5;
        double x6 = MULTIPLY(x2, x5);
        int64_t x7 = LESS(-0x1.0000000000000p-1, x6);
        double x8 = MULTIPLY(v[56][i], v[84][i]);
        double x9 = CHOOSE(x7, x8, 0x0.0p+0); v[90][i] = x9;
        double x10 = MULTIPLY(EM[i], v[81][i]);
        double x11 = MULTIPLY(x10, v[65][i]);
        double x12 = MULTIPLY(v[78][i], v[69][i]);
        double x13 = ADD(v[85][i], x12); v[91][i] = x13;
        double x14 = MULTIPLY(v[56][i], x13);
        double x15 = SUBTRACT(x11, x14);
        double x16 = DIVIDE(x15, v[83][i]); v[92][i] = x16;
        double x17 = MULTIPLY(x1, x16); v[93][i] = x17;
        double x18 = MULTIPLY(v[53][i], x17); v[94][i] = x18;
        double x19 = ADD(v[22][i], x12);
        double x20 = MULTIPLY(v[56][i], x19);
        double x21 = SUBTRACT(x11, x20);
        double x22 = MULTIPLY(v[54][i], x21);
        double x23 = MULTIPLY(v[82][i], v[13][i]);
        double x24 = ADD(x22, x23);
        double x25 = MULTIPLY(x24, v[84][i]); v[95][i] = x25;
        double x26 = MULTIPLY(x4, x16); v[96][i] = x26;
    }
    if (HAS(loops, 29)) EACH {
        double x0 = MULTIPLY(v[52][i], v[93][i]); v[65][i] = x0;
        double x1 = MULTIPLY(v[90][i], v[89][i]);
        int64_t x2 = LESS(v[38][i], x1);
        double x3 = MULTIPLY(v[53][i], v[96][i]); v[82][i] = x3;
        double x4 = SUBTRACT(VY[i], x3);
        double x5 = MULTIPLY(v[4][i], v[87][i]);
        double x6 = SUBTRACT(v[95][i], v[7][i]);
        double x7 = MULTIPLY(v[88][i], x6);
        double x8 = ADD(x5, x7);
        double x9 = ADD(x4, x8);
        double x10 = MULTIPLY(v[52][i], v[96][i]); v[97][i] = x10;
        double x11 = ADD(UY[i], x10);
        double x12 = CHOOSE(x2, x9, x11); v[98][i] = x12;
        int64_t x13 = LESS(v[39][i], x1);
        double x14 = SUBTRACT(x11, x8);
        double x15 = CHOOSE(x13, x14, x4); v[99][i] = x15;
    }
    if (HAS(loops, 30)) EACH {
        double x0 = MULTIPLY(v[90][i], v[87][i]);
        int64_t x1 = LESS(v[38][i], x0);
        double x2 = SUBTRACT(VX[i], v[94][i]);
        double x3 = MULTIPLY(v[5][i], v[89][i]);
        double x4 = SUBTRACT(v[95][i], v[12][i]);
        double x5 = MULTIPLY(v[86][i], x4);
        double x6 = ADD(x3, x5);
        double x7 = ADD(x2, x6);
        double x8 = ADD(UX[i], v[65][i]);
        double x9 = CHOOSE(x1, x7, x8); v[88][i] = x9;
        int64_t x10 = LESS(v[39][i], x0);
        double x11 = SUBTRACT(x8, x6);
        double x12 = CHOOSE(x10, x11, x2); v[93][i] = x12;
    }
    if (HAS(loops, 31)) EACH {
        double x0 = MULTIPLY(v[56][i], v[62][i]);
        double x1 = MULTIPLY(EM[i], v[67][i]);
        double x2 = SUBTRACT(x0, x1); v[86][i] = x2;
        double x3 = MULTIPLY(v[70][i], v[67][i]); v[87][i] = x3;
        double x4 = MULTIPLY(v[56][i], v[67][i]);
        double x5 = MULTIPLY(EM[i], v[62][i]);
        double x6 = SUBTRACT(x4, x5); v[89][i] = x6;
        double x7 = MULTIPLY(v[70][i], v[62][i]); v[90][i] = x7;
    }
    if (HAS(loops, 32)) EACH {
        double x0 = MULTIPLY(v[86][i], WA[i]);
        double x1 = MULTIPLY(v[87][i], WB[i]);
        double x2 = ADD(x0, x1);
        double x3 = MULTIPLY(v[54][i], x2);
        double x4 = MULTIPLY(v[58][i], v[80][i]);
        double x5 = SUBTRACT(v[77][i], x4);
        double x6 = MULTIPLY(v[85][i], x5);
        double x7 = SUBTRACT(x3, x6);
        double x8 = MULTIPLY(v[74][i], v[71][i]);
        double x9 = MULTIPLY(v[75][i], v[72][i]);
        double x10 = SUBTRACT(x8, x9);
        double x11 = MULTIPLY(EM[i], x10);
        double x12 = MULTIPLY(v[18][i], x11);
        double x13 = ADD(x7, x12);
        double x14 = MULTIPLY(x13, v[84][i]); v[62][i] = x14;
        double x15 = MULTIPLY(v[89][i], WB[i]);
        double x16 = MULTIPLY(v[90][i], WA[i]);
        double x17 = ADD(x15, x16);
        double x18 = MULTIPLY(v[54][i], x17);
        double x19 = MULTIPLY(v[59][i], v[80][i]);
        double x20 = ADD(v[77][i], x19);
        double x21 = MULTIPLY(v[85][i], x20);
        double x22 = SUBTRACT(x18, x21);
        double x23 = MULTIPLY(v[17][i], x11);
        double x24 = SUBTRACT(x22, x23);
        double x25 = MULTIPLY(x24, v[84][i]); v[67][i] = x25;
    }
    if (HAS(loops, 33)) EACH {
        double x0 = MULTIPLY(v[23][i], v[92][i]); v[77][i] = x0;
        double x1 = NEGATIVE(v[14][i]); v[80][i] = x1;
        double x2 = MULTIPLY(v[75][i], v[66][i]);
        double x3 = MULTIPLY(v[74][i], v[68][i]);
        double x4 = SUBTRACT(x2, x3); v[95][i] = x4;
    }
    if (HAS(loops, 34)) EACH {
        double x0 = SUBTRACT(v[80][i], v[15][i]);
        double x1 = MULTIPLY(x0, v[69][i]);
        double x2 = ADD(v[8][i], x1);
        double x3 = MULTIPLY(v[23][i], v[91][i]);
        double x4 = SUBTRACT(x2, x3);
        double x5 = MULTIPLY(v[54][i], x4);
        double x6 = MULTIPLY(v[8][i], v[78][i]);
        double x7 = MULTIPLY(x0, v[85][i]);
        double x8 = SUBTRACT(x6, x7);
        double x9 = MULTIPLY(v[76][i], x8);
        double x10 = ADD(x5, x9);
        double x11 = MULTIPLY(v[56][i], x10);
        double x12 = MULTIPLY(v[15][i], v[59][i]);
        double x13 = MULTIPLY(v[14][i], v[58][i]);
        double x14 = SUBTRACT(x12, x13); v[74][i] = x14;
        double x15 = MULTIPLY(x14, v[85][i]);
        double x16 = MULTIPLY(v[81][i], v[8][i]);
        double x17 = SUBTRACT(x15, x16);
        double x18 = MULTIPLY(v[79][i], x17);
        double x19 = MULTIPLY(v[23][i], v[81][i]);
        double x20 = SUBTRACT(x19, x14);
        double x21 = MULTIPLY(v[73][i], x20);
        double x22 = ADD(x18, x21);
        double x23 = MULTIPLY(v[14][i], v[18][i]);
        double x24 = MULTIPLY(v[17][i], v[15][i]);
        double x25 = SUBTRACT(x23, x24);
        double x26 = MULTIPLY(v[60][i], x25);
        double x27 = MULTIPLY(x26, v[95][i]);
        double x28 = ADD(x22, x27);
        double x29 = MULTIPLY(EM[i], x28);
        double x30 = ADD(x11, x29);
        double x31 = DIVIDE(x30, v[83][i]); v[75][i] = x31;
        double x32 = ADD(v[16][i], x31);
        double x33 = MULTIPLY(v[77][i], x32); v[96][i] = x33;
    }
    if (HAS(loops, 35)) EACH {
        double x0 = MULTIPLY(v[79][i], v[85][i]);
        double x1 = SUBTRACT(x0, v[73][i]);
        double x2 = MULTIPLY(v[78][i], v[95][i]);
        double x3 = SUBTRACT(x1, x2);
        double x4 = MULTIPLY(x3, v[84][i]);
        double x5 = MULTIPLY(v[70][i], x4); v[76][i] = x5;
        double x6 = MULTIPLY(EM[i], x4);
        double x7 = MULTIPLY(v[60][i], x6);
        double x8 = ADD(v[64][i], x7);
        double x9 = MULTIPLY(x5, x8); v[81][i] = x9;
    }
    if (HAS(loops, 36)) EACH {
        double x0 = MULTIPLY(v[51][i], v[92][i]); v[78][i] = x0;
        double x1 = ADD(x0, v[96][i]);
        double x2 = ADD(x1, v[81][i]); v[79][i] = x2;
        double x3 = MULTIPLY(0x1.9000000000000p+5, x2);
        double x4 = NEGATIVE(x3);
        double x5 = DIVIDE(x4, v[49][i]); v[84][i] = x5;
    }
    if (HAS(loops, 37)) EACH {
        double x0 = MULTIPLY(-0x1.0000000000000p-1, v[78][i]); v[85][i] = x0;
    }
    if (HAS(loops, 38)) EACH {
        double x0 = NEGATIVE(v[22][i]); v[78][i] = x0;
        double x1 = MULTIPLY(-0x1.0000000000000p-1, v[96][i]); v[91][i] = x1;
        double x2 = MULTIPLY(-0x1.0000000000000p-1, v[81][i]); v[95][i] = x2;
    }
    if (HAS(loops, 39)) EACH {
        double x0 = MULTIPLY(v[65][i], v[65][i]);
        double x1 = MULTIPLY(v[97][i], v[97][i]);
        double x2 = ADD(x0, x1);
        double x3 = SQRT(x2); v[81][i] = x3;
    }
    if (HAS(loops, 40)) EACH {
        double x0 = MULTIPLY(v[94][i], v[94][i]);
        double x1 = MULTIPLY(v[82][i], v[82][i]);
        double x2 = ADD(x0, x1);
        double x3 = SQRT(x2); v[65][i] = x3;
    }
    if (HAS(loops, 41)) EACH {
        double x0 = ABSOLUTE(v[56][i]); v[82][i] = x0;
        double x1 = ABSOLUTE(v[17][i]); v[94][i] = x1;
        double x2 = ABSOLUTE(v[18][i]); v[96][i] = x2;
        double x3 = ABSOLUTE(v[80][i]); v[97][i] = x3;
        double x4 = NEGATIVE(v[15][i]); v[100][i] = x4;
        double x5 = ABSOLUTE(x4); v[101][i] = x5;
        double x6 = ABSOLUTE(EM[i]); v[102][i] = x6;
        double x7 = MULTIPLY(x1, v[58][i]);
        double x8 = MULTIPLY(x2, v[59][i]);
        double x9 = ADD(x7, x8); v[103][i] = x9;
        double x10 = MULTIPLY(x3, v[58][i]);
        double x11 = MULTIPLY(x5, v[59][i]);
        double x12 = ADD(x10, x11); v[104][i] = x12;
    }
    if (HAS(loops, 42)) EACH {
        double x0 = MULTIPLY(v[33][i], v[59][i]);
        double x1 = MULTIPLY(v[26][i], v[58][i]);
        double x2 = SUBTRACT(x0, x1); v[105][i] = x2;
        double x3 = MULTIPLY(v[73][i], x2);
        double x4 = MULTIPLY(v[26][i], v[3][i]);
        double x5 = MULTIPLY(v[2][i], v[33][i]);
        double x6 = SUBTRACT(x4, x5);
        double x7 = MULTIPLY(v[60][i], x6); v[106][i] = x7;
        double x8 = MULTIPLY(v[3][i], v[66][i]);
        double x9 = MULTIPLY(v[2][i], v[68][i]);
        double x10 = SUBTRACT(x8, x9); v[107][i] = x10;
        double x11 = MULTIPLY(x7, x10);
        double x12 = SUBTRACT(x3, x11); v[108][i] = x12;
        double x13 = MULTIPLY(v[2][i], v[58][i]);
        double x14 = MULTIPLY(v[3][i], v[59][i]);
        double x15 = SUBTRACT(x13, x14); v[109][i] = x15;
        double x16 = MULTIPLY(v[61][i], x15); v[110][i] = x16;
        double x17 = NEGATIVE(v[26][i]);
        double x18 = SUBTRACT(x17, v[33][i]); v[111][i] = x18;
        double x19 = MULTIPLY(x18, v[69][i]); v[112][i] = x19;
        double x20 = ADD(v[2][i], v[3][i]); v[113][i] = x20;
        double x21 = MULTIPLY(v[56][i], v[63][i]); v[114][i] = x21;
        double x22 = MULTIPLY(v[26][i], v[68][i]);
        double x23 = MULTIPLY(v[33][i], v[66][i]);
        double x24 = SUBTRACT(x22, x23); v[115][i] = x24;
        double x25 = MULTIPLY(v[61][i], x2); v[116][i] = x25;
        double x26 = MULTIPLY(x20, x20);
        double x27 = MULTIPLY(x18, x18);
        double x28 = ADD(x26, x27); v[117][i] = x28;
        double x29 = MULTIPLY(x21, x28);
        double x30 = MULTIPLY(x16, x15); v[118][i] = x30;
        double x31 = MULTIPLY(x25, x2); v[119][i] = x31;
        double x32 = ADD(x30, x31);
        double x33 = MULTIPLY(v[63][i], v[55][i]); v[120][i] = x33;
        double x34 = MULTIPLY(x33, x6); v[121][i] = x34;
        double x35 = MULTIPLY(x7, x34); v[122][i] = x35;
        double x36 = ADD(x32, x35);
        double x37 = MULTIPLY(EM[i], x36);
        double x38 = SUBTRACT(x29, x37);
        double x39 = ADD(v[57][i], x38); v[123][i] = x39;
    }
    if (HAS(loops, 43)) EACH {
        double x0 = ADD(v[5][i], v[27][i]);
        double x1 = ADD(x0, v[34][i]);
        double x2 = MULTIPLY(v[0][i], x1);
        double x3 = SUBTRACT(v[4][i], v[29][i]);
        double x4 = SUBTRACT(x3, v[36][i]);
        double x5 = MULTIPLY(v[1][i], x4);
        double x6 = ADD(x2, x5);
        double x7 = MULTIPLY(E[i], x6);
        double x8 = MULTIPLY(v[0][i], x7); v[56][i] = x8;
        double x9 = ADD(v[5][i], x8); v[66][i] = x9;
        double x10 = MULTIPLY(v[1][i], x7); v[68][i] = x10;
        double x11 = ADD(v[4][i], x10); v[124][i] = x11;
        double x12 = MULTIPLY(v[73][i], v[109][i]);
        double x13 = MULTIPLY(v[106][i], v[115][i]);
        double x14 = ADD(x12, x13); v[125][i] = x14;
        double x15 = MULTIPLY(v[113][i], v[69][i]); v[126][i] = x15;
    }
    if (HAS(loops, 44)) EACH {
        double x0 = MULTIPLY(v[105][i], v[66][i]);
        double x1 = MULTIPLY(v[109][i], v[124][i]);
        double x2 = SUBTRACT(x0, x1);
        double x3 = MULTIPLY(v[110][i], x2);
        double x4 = SUBTRACT(v[108][i], x3);
        double x5 = MULTIPLY(EM[i], x4);
        double x6 = ADD(v[68][i], v[112][i]);
        double x7 = MULTIPLY(v[57][i], x6);
        double x8 = SUBTRACT(x5, x7);
        double x9 = MULTIPLY(v[113][i], v[124][i]);
        double x10 = MULTIPLY(v[111][i], v[66][i]);
        double x11 = SUBTRACT(x9, x10); v[27][i] = x11;
        double x12 = MULTIPLY(v[114][i], x11);
        double x13 = MULTIPLY(v[113][i], x12);
        double x14 = SUBTRACT(x8, x13);
        double x15 = MULTIPLY(v[57][i], v[4][i]);
        double x16 = SUBTRACT(x14, x15); v[29][i] = x16;
        double x17 = MULTIPLY(v[116][i], x2);
        double x18 = ADD(v[125][i], x17);
        double x19 = MULTIPLY(EM[i], x18);
        double x20 = ADD(v[56][i], v[126][i]);
        double x21 = MULTIPLY(v[57][i], x20);
        double x22 = SUBTRACT(x19, x21);
        double x23 = MULTIPLY(v[111][i], x12);
        double x24 = ADD(x22, x23);
        double x25 = MULTIPLY(v[57][i], v[5][i]);
        double x26 = SUBTRACT(x24, x25); v[34][i] = x26;
    }
    if (HAS(loops, 45)) EACH {
        double x0 = MULTIPLY(v[0][i], v[29][i]);
        double x1 = MULTIPLY(v[1][i], v[34][i]);
        double x2 = SUBTRACT(x0, x1); v[36][i] = x2;
        double x3 = MULTIPLY(v[0][i], v[34][i]);
        double x4 = MULTIPLY(v[1][i], v[29][i]);
        double x5 = ADD(x3, x4); v[69][i] = x5;
        double x6 = DIVIDE(x2, x5); v[109][i] = x6;
    }
    if (HAS(loops, 46)) EACH {
        double x0 = MULTIPLY(v[53][i], v[55][i]); v[23][i] = x0;
        double x1 = MULTIPLY(x0, UX[i]);
        double x2 = MULTIPLY(v[52][i], v[55][i]); v[38][i] = x2;
        double x3 = MULTIPLY(x2, VX[i]);
        double x4 = ADD(x1, x3); v[39][i] = x4;
        double x5 = MULTIPLY(x0, UY[i]);
        double x6 = MULTIPLY(x2, VY[i]);
        double x7 = ADD(x5, x6); v[40][i] = x7;
    }
    if (HAS(loops, 47)) EACH {
        double x0 = MULTIPLY(v[114][i], v[113][i]);
        double x1 = MULTIPLY(x0, v[113][i]);
        double x2 = MULTIPLY(EM[i], v[118][i]);
        double x3 = SUBTRACT(x1, x2);
        double x4 = MULTIPLY(EM[i], v[122][i]);
        double x5 = SUBTRACT(x3, x4);
        double x6 = ABSOLUTE(x5);
        double x7 = MULTIPLY(v[114][i], v[111][i]);
        double x8 = MULTIPLY(x7, v[111][i]);
        double x9 = MULTIPLY(EM[i], v[119][i]);
        double x10 = SUBTRACT(x8, x9);
        double x11 = ADD(v[57][i], x10);
        double x12 = ABSOLUTE(x11);
        int64_t x13 = LESS(x6, x12);
        double x14 = CHOOSE(x13, v[39][i], UX[i]);
        double x15 = MULTIPLY(EM[i], v[125][i]);
        double x16 = MULTIPLY(v[57][i], v[126][i]);
        double x17 = SUBTRACT(x15, x16);
        double x18 = MULTIPLY(x0, v[111][i]);
        double x19 = MULTIPLY(v[110][i], v[105][i]);
        double x20 = MULTIPLY(EM[i], x19);
        double x21 = SUBTRACT(x18, x20);
        double x22 = MULTIPLY(x21, v[124][i]);
        double x23 = ADD(x17, x22);
        double x24 = MULTIPLY(x11, v[56][i]);
        double x25 = SUBTRACT(x23, x24);
        double x26 = NEGATIVE(x11);
        double x27 = CHOOSE(x13, x5, x26);
        double x28 = MULTIPLY(x27, v[5][i]);
        double x29 = ADD(x25, x28);
        double x30 = DIVIDE(x29, v[123][i]);
        double x31 = MULTIPLY(v[38][i], x30);
        double x32 = ADD(x14, x31); v[62][i] = x32;
        double x33 = SUBTRACT(x10, x4);
        double x34 = ABSOLUTE(x33);
        double x35 = ADD(v[57][i], x3);
        double x36 = ABSOLUTE(x35);
        int64_t x37 = LESS(x34, x36);
        double x38 = CHOOSE(x37, v[40][i], UY[i]);
        double x39 = MULTIPLY(EM[i], v[108][i]);
        double x40 = MULTIPLY(v[57][i], v[112][i]);
        double x41 = SUBTRACT(x39, x40);
        double x42 = MULTIPLY(x21, v[66][i]);
        double x43 = ADD(x41, x42);
        double x44 = MULTIPLY(x35, v[68][i]);
        double x45 = SUBTRACT(x43, x44);
        double x46 = NEGATIVE(x35);
        double x47 = CHOOSE(x37, x33, x46);
        double x48 = MULTIPLY(x47, v[4][i]);
        double x49 = ADD(x45, x48);
        double x50 = DIVIDE(x49, v[123][i]);
        double x51 = MULTIPLY(v[38][i], x50);
        double x52 = ADD(x38, x51); v[65][i] = x52;
        double x53 = CHOOSE(x13, v[39][i], VX[i]);
        double x54 = MULTIPLY(v[23][i], x30);
        double x55 = SUBTRACT(x53, x54); v[67][i] = x55;
        double x56 = CHOOSE(x37, v[40][i], VY[i]);
        double x57 = MULTIPLY(v[23][i], x50);
        double x58 = SUBTRACT(x56, x57); v[74][i] = x58;
    }
    if (HAS(loops, 48)) EACH {
        double x0 = MULTIPLY(v[54][i], WA[i]);
        double x1 = MULTIPLY(v[2][i], v[66][i]);
        double x2 = MULTIPLY(v[26][i], v[124][i]);
        double x3 = SUBTRACT(x1, x2);
        double x4 = MULTIPLY(v[58][i], x3);
        double x5 = SUBTRACT(x0, x4);
        double x6 = MULTIPLY(v[86][i], x5);
        double x7 = MULTIPLY(v[54][i], WB[i]);
        double x8 = MULTIPLY(v[3][i], v[66][i]);
        double x9 = MULTIPLY(v[33][i], v[124][i]);
        double x10 = SUBTRACT(x8, x9);
        double x11 = MULTIPLY(v[59][i], x10);
        double x12 = SUBTRACT(x7, x11);
        double x13 = MULTIPLY(v[87][i], x12);
        double x14 = ADD(x6, x13);
        double x15 = MULTIPLY(v[2][i], v[3][i]);
        double x16 = MULTIPLY(v[26][i], v[33][i]);
        double x17 = ADD(x15, x16);
        double x18 = MULTIPLY(x17, v[71][i]);
        double x19 = MULTIPLY(v[3][i], v[3][i]);
        double x20 = MULTIPLY(v[33][i], v[33][i]);
        double x21 = ADD(x19, x20);
        double x22 = MULTIPLY(x21, v[72][i]);
        double x23 = SUBTRACT(x18, x22);
        double x24 = MULTIPLY(v[106][i], v[120][i]);
        double x25 = MULTIPLY(v[3][i], v[124][i]);
        double x26 = MULTIPLY(v[33][i], v[66][i]);
        double x27 = ADD(x25, x26);
        double x28 = MULTIPLY(x24, x27);
        double x29 = SUBTRACT(x23, x28);
        double x30 = MULTIPLY(EM[i], x29);
        double x31 = ADD(x14, x30);
        double x32 = DIVIDE(x31, v[123][i]); v[56][i] = x32;
        double x33 = MULTIPLY(v[89][i], x12);
        double x34 = MULTIPLY(v[90][i], x5);
        double x35 = ADD(x33, x34);
        double x36 = MULTIPLY(x17, v[72][i]);
        double x37 = MULTIPLY(v[2][i], v[2][i]);
        double x38 = MULTIPLY(v[26][i], v[26][i]);
        double x39 = ADD(x37, x38);
        double x40 = MULTIPLY(x39, v[71][i]);
        double x41 = SUBTRACT(x36, x40);
        double x42 = MULTIPLY(v[2][i], v[124][i]);
        double x43 = MULTIPLY(v[26][i], v[66][i]);
        double x44 = ADD(x42, x43);
        double x45 = MULTIPLY(x24, x44);
        double x46 = ADD(x41, x45);
        double x47 = MULTIPLY(EM[i], x46);
        double x48 = ADD(x35, x47);
        double x49 = DIVIDE(x48, v[123][i]); v[57][i] = x49;
    }
    if (HAS(loops, 49)) EACH {
        double x0 = ABSOLUTE(VX[i]); v[68][i] = x0;
        double x1 = ADD(PB[i], TB[i]);
        double x2 = MULTIPLY(0x1.1df46a2529d39p-6, x1);
        double x3 = MULTIPLY(x2, v[67][i]); v[71][i] = x3;
        double x4 = ABSOLUTE(v[1][i]); v[72][i] = x4;
        double x5 = ABSOLUTE(v[16][i]); v[86][i] = x5;
        double x6 = ADD(v[40][i], x5);
        double x7 = MULTIPLY(v[54][i], v[77][i]);
        double x8 = ABSOLUTE(x7);
        double x9 = ADD(x6, x8); v[87][i] = x9;
        double x10 = ABSOLUTE(v[0][i]); v[89][i] = x10;
        double x11 = ABSOLUTE(E[i]);
        double x12 = ABSOLUTE(v[13][i]);
        double x13 = ABSOLUTE(v[19][i]);
        double x14 = ADD(x12, x13);
        double x15 = ABSOLUTE(v[20][i]);
        double x16 = ADD(x14, x15);
        double x17 = MULTIPLY(x11, x16);
        double x18 = MULTIPLY(x10, x17); v[90][i] = x18;
        double x19 = ABSOLUTE(UX[i]); v[105][i] = x19;
        double x20 = ADD(PA[i], TA[i]);
        double x21 = MULTIPLY(0x1.1df46a2529d39p-6, x20);
        double x22 = MULTIPLY(x21, v[62][i]); v[106][i] = x22;
        double x23 = MULTIPLY(v[0][i], v[22][i]); v[108][i] = x23;
        double x24 = ABSOLUTE(VY[i]); v[112][i] = x24;
        double x25 = MULTIPLY(x4, x17); v[114][i] = x25;
        double x26 = ABSOLUTE(UY[i]); v[118][i] = x26;
        double x27 = MULTIPLY(v[1][i], v[22][i]); v[119][i] = x27;
        int64_t x28 = LESS_OR_EQUAL(0x0.0p+0, v[21][i]); v[120][i] = x28 ? 1.0 : 0.0;
        double x29 = MULTIPLY(0x1.19799812dea11p-39, v[49][i]); v[122][i] = x29;
        double x30 = ABSOLUTE(DA[i]);
        double x31 = MULTIPLY(0x1.12e0be826d695p-30, x30);
        int64_t x32 = LESS(x31, v[80][i]);
        double x33 = MULTIPLY((x32 ? 1.0 : 0.0), 0x1.0000000000000p+8); v[125][i] = x33;
        double x34 = ABSOLUTE(DB[i]);
        double x35 = MULTIPLY(0x1.12e0be826d695p-30, x34);
        int64_t x36 = LESS(x35, v[100][i]);
        double x37 = MULTIPLY((x36 ? 1.0 : 0.0), 0x1.0000000000000p+9); v[126][i] = x37;
        int64_t x38 = LESS(EM[i], -0x1.0000000000000p+0);
        int64_t x39 = LESS(0x0.0p+0, EM[i]);
        int64_t x40 = LESS(EM[i], 0x1.0000000000000p+0);
        int64_t x41 = LESS(0x1.0000000000000p+0, EM[i]);
        int64_t x42 = EITHER(x40, x41);
        int64_t x43 = BOTH(x39, x42);
        int64_t x44 = EITHER(x38, x43);
        double x45 = MULTIPLY((x44 ? 1.0 : 0.0), 0x1.0000000000000p+10); v[127][i] = x45;
        double x46 = MULTIPLY(x2, v[57][i]); v[128][i] = x46;
        double x47 = MULTIPLY(x21, v[56][i]); v[129][i] = x47;
    }
    if (HAS(loops, 50)) EACH {
        double x0 = ABSOLUTE(v[93][i]);
        double x1 = ADD(v[68][i], x0);
        double x2 = MULTIPLY(v[3][i], v[67][i]);
        double x3 = NEGATIVE(x2);
        double x4 = ABSOLUTE(x3);
        double x5 = ADD(x1, x4);
        double x6 = MULTIPLY(v[33][i], v[71][i]);
        double x7 = ABSOLUTE(x6);
        double x8 = ADD(x5, x7);
        double x9 = MULTIPLY(v[72][i], v[87][i]);
        double x10 = ADD(x9, v[90][i]);
        double x11 = ADD(x8, x10);
        double x12 = ABSOLUTE(v[88][i]);
        double x13 = ADD(v[105][i], x12);
        double x14 = MULTIPLY(v[2][i], v[62][i]);
        double x15 = ABSOLUTE(x14);
        double x16 = ADD(x13, x15);
        double x17 = MULTIPLY(v[26][i], v[106][i]);
        double x18 = ABSOLUTE(x17);
        double x19 = ADD(x16, x18);
        int64_t x20 = LESS(x11, x19);
        double x21 = SUBTRACT(v[93][i], x2);
        double x22 = NEGATIVE(v[108][i]);
        double x23 = MULTIPLY(v[1][i], v[75][i]);
        double x24 = SUBTRACT(x22, x23);
        double x25 = ADD(x21, x24);
        double x26 = ADD(v[88][i], x14);
        double x27 = CHOOSE(x20, x25, x26); v[19][i] = x27;
        double x28 = ADD(x19, x10);
        int64_t x29 = LESS(x28, x8);
        double x30 = SUBTRACT(x26, x24);
        double x31 = CHOOSE(x29, x30, x21); v[20][i] = x31;
    }
    if (HAS(loops, 51)) EACH {
        double x0 = ABSOLUTE(v[99][i]);
        double x1 = ADD(v[112][i], x0);
        double x2 = MULTIPLY(v[33][i], v[67][i]);
        double x3 = ABSOLUTE(x2);
        double x4 = ADD(x1, x3);
        double x5 = MULTIPLY(v[3][i], v[71][i]);
        double x6 = ABSOLUTE(x5);
        double x7 = ADD(x4, x6);
        double x8 = MULTIPLY(v[89][i], v[87][i]);
        double x9 = ADD(x8, v[114][i]);
        double x10 = ADD(x7, x9);
        double x11 = ABSOLUTE(v[98][i]);
        double x12 = ADD(v[118][i], x11);
        double x13 = MULTIPLY(v[26][i], v[62][i]);
        double x14 = NEGATIVE(x13);
        double x15 = ABSOLUTE(x14);
        double x16 = ADD(x12, x15);
        double x17 = MULTIPLY(v[2][i], v[106][i]);
        double x18 = ABSOLUTE(x17);
        double x19 = ADD(x16, x18);
        int64_t x20 = LESS(x10, x19);
        double x21 = ADD(v[99][i], x2);
        double x22 = MULTIPLY(v[0][i], v[75][i]);
        double x23 = SUBTRACT(x22, v[119][i]);
        double x24 = ADD(x21, x23);
        double x25 = SUBTRACT(v[98][i], x13);
        double x26 = CHOOSE(x20, x24, x25); v[22][i] = x26;
        double x27 = ADD(x19, x9);
        int64_t x28 = LESS(x27, x7);
        double x29 = SUBTRACT(x25, x23);
        double x30 = CHOOSE(x28, x29, x21); v[56][i] = x30;
        double x31 = MULTIPLY(v[88][i], v[88][i]);
        double x32 = MULTIPLY(v[98][i], v[98][i]);
        double x33 = ADD(x31, x32);
        double x34 = MULTIPLY(v[42][i], x33);
        double x35 = MULTIPLY(v[93][i], v[93][i]);
        double x36 = MULTIPLY(v[99][i], v[99][i]);
        double x37 = ADD(x35, x36);
        double x38 = MULTIPLY(v[43][i], x37);
        double x39 = ADD(x34, x38);
        double x40 = MULTIPLY(v[62][i], v[62][i]);
        double x41 = MULTIPLY(v[45][i], x40);
        double x42 = ADD(x39, x41);
        double x43 = MULTIPLY(v[67][i], v[67][i]);
        double x44 = MULTIPLY(v[47][i], x43);
        double x45 = ADD(x42, x44);
        double x46 = MULTIPLY(0x1.0000000000000p-1, x45); v[57][i] = x46;
    }
    if (HAS(loops, 52)) EACH {
        double x0 = ABSOLUTE(v[67][i]);
        double x1 = ADD(v[68][i], x0);
        double x2 = MULTIPLY(v[3][i], v[57][i]);
        double x3 = NEGATIVE(x2);
        double x4 = ABSOLUTE(x3);
        double x5 = ADD(x1, x4);
        double x6 = MULTIPLY(v[33][i], v[128][i]);
        double x7 = ABSOLUTE(x6);
        double x8 = ADD(x5, x7);
        double x9 = ADD(x8, v[90][i]);
        double x10 = ABSOLUTE(v[62][i]);
        double x11 = ADD(v[105][i], x10);
        double x12 = MULTIPLY(v[2][i], v[56][i]);
        double x13 = ABSOLUTE(x12);
        double x14 = ADD(x11, x13);
        double x15 = MULTIPLY(v[26][i], v[129][i]);
        double x16 = ABSOLUTE(x15);
        double x17 = ADD(x14, x16);
        int64_t x18 = LESS(x9, x17);
        double x19 = SUBTRACT(v[67][i], x2);
        double x20 = SUBTRACT(x19, v[108][i]);
        double x21 = ADD(v[62][i], x12);
        double x22 = CHOOSE(x18, x20, x21); v[19][i] = x22;
        double x23 = ADD(x17, v[90][i]);
        int64_t x24 = LESS(x23, x8);
        double x25 = ADD(x21, v[108][i]);
        double x26 = CHOOSE(x24, x25, x19); v[20][i] = x26;
    }
    if (HAS(loops, 53)) EACH {
        double x0 = ABSOLUTE(v[74][i]);
        double x1 = ADD(v[112][i], x0);
        double x2 = MULTIPLY(v[33][i], v[57][i]);
        double x3 = ABSOLUTE(x2);
        double x4 = ADD(x1, x3);
        double x5 = MULTIPLY(v[3][i], v[128][i]);
        double x6 = ABSOLUTE(x5);
        double x7 = ADD(x4, x6);
        double x8 = ADD(x7, v[114][i]);
        double x9 = ABSOLUTE(v[65][i]);
        double x10 = ADD(v[118][i], x9);
        double x11 = MULTIPLY(v[26][i], v[56][i]);
        double x12 = NEGATIVE(x11);
        double x13 = ABSOLUTE(x12);
        double x14 = ADD(x10, x13);
        double x15 = MULTIPLY(v[2][i], v[129][i]);
        double x16 = ABSOLUTE(x15);
        double x17 = ADD(x14, x16);
        int64_t x18 = LESS(x8, x17);
        double x19 = ADD(v[74][i], x2);
        double x20 = SUBTRACT(x19, v[119][i]);
        double x21 = SUBTRACT(v[65][i], x11);
        double x22 = CHOOSE(x18, x20, x21); v[22][i] = x22;
        double x23 = ADD(x17, v[114][i]);
        int64_t x24 = LESS(x23, x7);
        double x25 = ADD(x21, v[119][i]);
        double x26 = CHOOSE(x24, x25, x19); v[68][i] = x26;
    }
    if (HAS(loops, 54)) EACH {
        double x0 = MULTIPLY(v[110][i], v[66][i]);
        double x1 = MULTIPLY(v[116][i], v[124][i]);
        double x2 = ADD(x0, x1);
        double x3 = SUBTRACT(x2, v[73][i]);
        double x4 = MULTIPLY(v[113][i], v[107][i]);
        double x5 = MULTIPLY(v[111][i], v[115][i]);
        double x6 = ADD(x4, x5);
        double x7 = MULTIPLY(v[121][i], v[27][i]);
        double x8 = ADD(x6, x7);
        double x9 = SUBTRACT(x3, x8);
        double x10 = DIVIDE(x9, v[123][i]); v[2][i] = x10;
        double x11 = MULTIPLY(v[70][i], x10); v[3][i] = x11;
    }
    if (HAS(loops, 55)) EACH {
        double x0 = MULTIPLY(v[54][i], v[123][i]);
        double x1 = DIVIDE(v[34][i], x0); v[26][i] = x1;
        double x2 = DIVIDE(v[29][i], x0); v[27][i] = x2;
        double x3 = MULTIPLY(v[0][i], x1);
        double x4 = MULTIPLY(v[1][i], x2);
        double x5 = ADD(x3, x4); v[33][i] = x5;
        double x6 = MULTIPLY(v[51][i], x5); v[66][i] = x6;
        double x7 = MULTIPLY(v[0][i], x2);
        double x8 = MULTIPLY(v[1][i], x1);
        double x9 = SUBTRACT(x7, x8); v[70][i] = x9;
        double x10 = MULTIPLY(x9, v[16][i]); v[71][i] = x10;
        double x11 = MULTIPLY(-0x1.0000000000000p-1, x6); v[72][i] = x11;
        double x12 = MULTIPLY(-0x1.0000000000000p-1, x10); v[73][i] = x12;
        double x13 = MULTIPLY(v[52][i], x1);
        double x14 = MULTIPLY(x13, x13);
        double x15 = MULTIPLY(v[52][i], x2);
        double x16 = MULTIPLY(x15, x15);
        double x17 = ADD(x14, x16);
        double x18 = SQRT(x17); v[75][i] = x18;
        double x19 = MULTIPLY(v[53][i], x1);
        double x20 = MULTIPLY(x19, x19);
        double x21 = MULTIPLY(v[53][i], x2);
        double x22 = MULTIPLY(x21, x21);
        double x23 = ADD(x20, x22);
        double x24 = SQRT(x23); v[76][i] = x24;
    }
    if (HAS(loops, 56)) EACH {
        double x0 = MULTIPLY(EM[i], v[2][i]);
        double x1 = MULTIPLY(v[60][i], x0);
        double x2 = ADD(v[64][i], x1);
        double x3 = MULTIPLY(v[3][i], x2); v[29][i] = x3;
        double x4 = ADD(v[66][i], v[71][i]);
        double x5 = ADD(x4, x3); v[34][i] = x5;
        double x6 = NEGATIVE(x5); v[51][i] = x6;
        double x7 = MULTIPLY(-0x1.0000000000000p-1, x3); v[79][i] = x7;
    }
    if (HAS(loops, 57)) EACH {
        double x0 = MULTIPLY(v[63][i], v[117][i]);
        double x1 = ADD(v[54][i], x0);
        double x2 = MULTIPLY(v[82][i], x1);
        double x3 = MULTIPLY(v[103][i], v[103][i]);
        double x4 = MULTIPLY(v[104][i], v[104][i]);
        double x5 = ADD(x3, x4);
        double x6 = MULTIPLY(v[61][i], x5);
        double x7 = ABSOLUTE(v[121][i]);
        double x8 = MULTIPLY(v[94][i], v[101][i]);
        double x9 = MULTIPLY(v[97][i], v[96][i]);
        double x10 = ADD(x8, x9);
        double x11 = MULTIPLY(v[60][i], x10);
        double x12 = MULTIPLY(x7, x11);
        double x13 = ADD(x6, x12);
        double x14 = MULTIPLY(v[102][i], x13);
        double x15 = ADD(x2, x14);
        double x16 = ABSOLUTE(v[123][i]);
        double x17 = DIVIDE(x15, x16);
        double x18 = MULTIPLY(0x1.8000000000000p+1, x17); v[2][i] = x18;
    }
    if (HAS(loops, 58)) EACH {
        int64_t x0 = EQUAL(MB[i], INFINITY); v[60][i] = x0 ? 1.0 : 0.0;
        double x1 = SQRT(v[52][i]); v[64][i] = x1;
        int64_t x2 = EQUAL(MA[i], INFINITY); v[80][i] = x2 ? 1.0 : 0.0;
        double x3 = SQRT(v[53][i]); v[87][i] = x3;
        int64_t x4 = LESS(E[i], 0x0.0p+0);
        int64_t x5 = LESS(0x1.0000000000000p+0, E[i]);
        int64_t x6 = EITHER(x4, x5);
        double x7 = MULTIPLY((x6 ? 1.0 : 0.0), 0x1.0000000000000p+4); v[89][i] = x7;
        int64_t x8 = LESS_OR_EQUAL(0x0.0p+0, -0x1.4000000000000p+3);
        double x9 = MULTIPLY((x8 ? 1.0 : 0.0), 0x1.0000000000000p+11); v[90][i] = x9;
    }
    if (HAS(loops, 59)) EACH {
        double x0 = NEGATIVE(v[79][i]); v[2][i] = x0;
        int64_t x1 = LESS(x0, 0x0.0p+0);
        double x2 = CHOOSE(x1, 0x0.0p+0, x0);
        double x3 = SQRT(x2);
        double x4 = MULTIPLY(0x1.0000000000000p-1, x2);
        double x5 = SQRT(x4);
        double x6 = CHOOSE((v[60][i] != 0.0), x3, x5);
        double x7 = MULTIPLY(x6, v[64][i]); v[3][i] = x7;
        double x8 = CHOOSE((v[80][i] != 0.0), x3, x5);
        double x9 = MULTIPLY(x8, v[87][i]); v[26][i] = x9;
        double x10 = ABSOLUTE(v[23][i]); v[27][i] = x10;
        double x11 = ADD(0x1.0000000000000p+0, x10);
        double x12 = MULTIPLY(v[54][i], x11);
        double x13 = ADD(v[94][i], v[96][i]);
        double x14 = ADD(v[97][i], v[101][i]);
        double x15 = MULTIPLY(x10, x14);
        double x16 = ADD(x13, x15);
        double x17 = MULTIPLY(x13, x16);
        double x18 = MULTIPLY(v[63][i], x17);
        double x19 = ADD(x12, x18);
        double x20 = MULTIPLY(v[82][i], x19);
        double x21 = MULTIPLY(x10, v[104][i]);
        double x22 = ADD(v[103][i], x21);
        double x23 = MULTIPLY(v[103][i], x22);
        double x24 = MULTIPLY(v[61][i], x23);
        double x25 = MULTIPLY(v[102][i], x24);
        double x26 = ADD(x20, x25);
        double x27 = ABSOLUTE(v[83][i]);
        double x28 = DIVIDE(x26, x27);
        double x29 = MULTIPLY(0x1.8000000000000p+1, x28); v[29][i] = x29;
    }
    if (HAS(loops, 60)) EACH {
        int64_t x0 = LESS(v[92][i], 0x0.0p+0);
        double x1 = MULTIPLY((x0 ? 1.0 : 0.0), 0x1.0000000000000p+1);
        double x2 = ADD(((v[120][i] != 0.0) ? 1.0 : 0.0), x1);
        int64_t x3 = LESS(v[122][i], v[79][i]);
        double x4 = MULTIPLY((x3 ? 1.0 : 0.0), 0x1.0000000000000p+3);
        double x5 = ADD(x2, x4);
        double x6 = ADD(x5, v[89][i]);
        int64_t x7 = LESS(v[29][i], 0x1.0000000000000p+26);
        int64_t x8 = NOT(x7);
        double x9 = MULTIPLY((x8 ? 1.0 : 0.0), 0x1.0000000000000p+5);
        double x10 = ADD(x6, x9);
        double x11 = ADD(v[88][i], v[98][i]);
        double x12 = ADD(x11, v[93][i]);
        double x13 = ADD(x12, v[99][i]);
        double x14 = ADD(x13, v[62][i]);
        double x15 = ADD(x14, v[67][i]);
        double x16 = ABSOLUTE(x15);
        int64_t x17 = LESS(x16, INFINITY);
        double x18 = MULTIPLY(0x1.0000000000000p-1, v[79][i]);
        double x19 = ADD(v[49][i], x18);
        double x20 = ABSOLUTE(x19);
        int64_t x21 = LESS(x20, INFINITY);
        int64_t x22 = BOTH(x17, x21);
        double x23 = DIVIDE(v[2][i], v[49][i]);
        double x24 = ABSOLUTE(x23);
        int64_t x25 = LESS(x24, INFINITY);
        int64_t x26 = BOTH(x22, x25);
        int64_t x27 = LESS_OR_EQUAL(v[29][i], INFINITY);
        int64_t x28 = BOTH(x26, x27);
        int64_t x29 = NOT(x28);
        double x30 = MULTIPLY((x29 ? 1.0 : 0.0), 0x1.0000000000000p+6);
        double x31 = ADD(x10, x30);
        double x32 = ADD(x31, v[125][i]);
        double x33 = ADD(x32, v[126][i]);
        double x34 = ADD(x33, v[127][i]);
        int64_t x35 = LESS_OR_EQUAL(v[23][i], -0x1.4000000000000p+3);
        double x36 = MULTIPLY((x35 ? 1.0 : 0.0), 0x1.0000000000000p+11);
        double x37 = ADD(x34, x36);
        int64_t x38 = LESS(v[21][i], 0x0.0p+0);
        int64_t x39 = LESS(0x0.0p+0, v[92][i]);
        int64_t x40 = BOTH(x38, x39);
        int64_t x41 = LESS(v[123][i], 0x0.0p+0);
        double x42 = CHOOSE(x41, -0x1.0000000000000p+0, 0x1.0000000000000p+0);
        double x43 = MULTIPLY(v[69][i], x42);
        int64_t x44 = LESS(0x0.0p+0, x43);
        int64_t x45 = BOTH(x40, x44);
        double x46 = ABSOLUTE(v[36][i]);
        double x47 = MULTIPLY(v[36][i], x42);
        double x48 = NEGATIVE(x47);
        double x49 = AGAINST(v[23][i], x48);
        double x50 = SUBTRACT(x49, 0x1.12e0be826d695p-30);
        double x51 = MULTIPLY(x50, x43);
        int64_t x52 = LESS(x46, x51);
        int64_t x53 = BOTH(x45, x52);
        int64_t x54 = LESS(x49, -0x1.12e0be826d695p-30);
        int64_t x55 = BOTH(x40, x54);
        double x56 = MULTIPLY(0x1.12e0be826d695p-30, x43);
        int64_t x57 = LESS_OR_EQUAL(x46, x56);
        int64_t x58 = BOTH(x44, x57);
        int64_t x59 = BOTH(x55, x58);
        int64_t x60 = EITHER(x53, x59);
        double x61 = MULTIPLY(v[17][i], v[14][i]);
        double x62 = MULTIPLY(x61, v[58][i]);
        double x63 = NEGATIVE(x62);
        double x64 = MULTIPLY(v[18][i], v[15][i]);
        double x65 = MULTIPLY(x64, v[59][i]);
        double x66 = SUBTRACT(x63, x65);
        double x67 = MULTIPLY(x66, v[92][i]);
        double x68 = MULTIPLY(v[74][i], v[76][i]);
        double x69 = ADD(x67, x68);
        double x70 = MULTIPLY(v[16][i], x69);
        int64_t x71 = LESS_OR_EQUAL(0x0.0p+0, x70);
        double x72 = MULTIPLY(v[23][i], v[16][i]);
        int64_t x73 = LESS_OR_EQUAL(0x0.0p+0, x72);
        int64_t x74 = EITHER(x71, x73);
        double x75 = ADD(v[86][i], v[86][i]);
        double x76 = ABSOLUTE(x69);
        double x77 = SUBTRACT(x75, x76);
        int64_t x78 = LESS_OR_EQUAL(x77, 0x0.0p+0);
        double x79 = MULTIPLY(0x1.8000000000000p+1, x76);
        int64_t x80 = LESS_OR_EQUAL(x79, x77);
        int64_t x81 = EITHER(x78, x80);
        int64_t x82 = EITHER(x74, x81);
        double x83 = SUBTRACT(v[27][i], 0x1.12e0be826d695p-30);
        double x84 = MULTIPLY(v[14][i], v[14][i]);
        double x85 = MULTIPLY(x84, v[58][i]);
        double x86 = MULTIPLY(v[15][i], v[15][i]);
        double x87 = MULTIPLY(x86, v[59][i]);
        double x88 = ADD(x85, x87);
        double x89 = ADD(v[54][i], x88);
        double x90 = MULTIPLY(v[92][i], x89);
        double x91 = MULTIPLY(x83, x90);
        double x92 = SUBTRACT(x77, x91);
        int64_t x93 = LESS(x92, 0x0.0p+0);
        int64_t x94 = EITHER(x82, x93);
        double x95 = MULTIPLY(x92, x92);
        double x96 = MULTIPLY(x76, x91);
        double x97 = MULTIPLY(0x1.0000000000000p+2, x96);
        int64_t x98 = LESS(x95, x97);
        int64_t x99 = EITHER(x94, x98);
        int64_t x100 = NOT(x99);
        int64_t x101 = NOT(x100);
        int64_t x102 = BOTH(x60, x101);
        double x103 = MULTIPLY((x102 ? 1.0 : 0.0), 0x1.0000000000000p+12);
        double x104 = ADD(x37, x103);
        int64_t x105 = NOT(x58);
        int64_t x106 = BOTH(x55, x105);
        int64_t x107 = LESS(0x0.0p+0, x46);
        int64_t x108 = BOTH(x106, x107);
        int64_t x109 = BOTH(x108, x101);
        double x110 = MULTIPLY((x109 ? 1.0 : 0.0), 0x1.0000000000000p+13);
        double x111 = ADD(x104, x110); v[33][i] = x111;
    }
    if (HAS(loops, 61)) EACH {
        double x0 = MULTIPLY(v[62][i], v[62][i]);
        double x1 = MULTIPLY(v[65][i], v[65][i]);
        double x2 = ADD(x0, x1);
        double x3 = MULTIPLY(v[42][i], x2);
        double x4 = MULTIPLY(v[67][i], v[67][i]);
        double x5 = MULTIPLY(v[74][i], v[74][i]);
        double x6 = ADD(x4, x5);
        double x7 = MULTIPLY(v[43][i], x6);
        double x8 = ADD(x3, x7);
        double x9 = MULTIPLY(v[56][i], v[56][i]);
        double x10 = MULTIPLY(v[45][i], x9);
        double x11 = ADD(x8, x10);
        double x12 = MULTIPLY(v[57][i], v[57][i]);
        double x13 = MULTIPLY(v[47][i], x12);
        double x14 = ADD(x11, x13);
        double x15 = MULTIPLY(0x1.0000000000000p-1, x14); v[14][i] = x15;
        double x16 = SUBTRACT(v[62][i], v[67][i]);
        double x17 = ADD(v[5][i], x16);
        double x18 = MULTIPLY(v[26][i], x17);
        double x19 = ABSOLUTE(x18);
        double x20 = SUBTRACT(v[65][i], v[74][i]);
        double x21 = ADD(v[4][i], x20);
        double x22 = MULTIPLY(v[27][i], x21);
        double x23 = ABSOLUTE(x22);
        double x24 = ADD(x19, x23);
        double x25 = ADD(v[46][i], x9);
        double x26 = MULTIPLY(v[45][i], x25);
        double x27 = ADD(v[48][i], x12);
        double x28 = MULTIPLY(v[47][i], x27);
        double x29 = ADD(x26, x28);
        double x30 = ADD(x24, x29);
        double x31 = ABSOLUTE(v[66][i]);
        double x32 = ABSOLUTE(v[71][i]);
        double x33 = ADD(x31, x32);
        double x34 = ABSOLUTE(v[29][i]);
        double x35 = ADD(x33, x34);
        int64_t x36 = LESS(x30, x35);
        double x37 = SUBTRACT(WA[i], v[56][i]);
        double x38 = ADD(WA[i], v[56][i]);
        double x39 = MULTIPLY(x37, x38);
        double x40 = MULTIPLY(v[45][i], x39);
        double x41 = SUBTRACT(WB[i], v[57][i]);
        double x42 = ADD(WB[i], v[57][i]);
        double x43 = MULTIPLY(x41, x42);
        double x44 = MULTIPLY(v[47][i], x43);
        double x45 = ADD(x40, x44);
        double x46 = ADD(x18, x22);
        double x47 = SUBTRACT(x45, x46);
        double x48 = CHOOSE(x36, x47, v[51][i]);
        double x49 = MULTIPLY(0x1.9000000000000p+5, x48);
        double x50 = DIVIDE(x49, v[49][i]); v[15][i] = x50;
        int64_t x51 = LESS(x48, 0x0.0p+0);
        double x52 = CHOOSE(x51, 0x0.0p+0, x48);
        double x53 = SQRT(x52);
        double x54 = MULTIPLY(0x1.0000000000000p-1, x52);
        double x55 = SQRT(x54);
        double x56 = CHOOSE((v[60][i] != 0.0), x53, x55);
        double x57 = MULTIPLY(x56, v[64][i]); v[17][i] = x57;
        double x58 = CHOOSE((v[80][i] != 0.0), x53, x55);
        double x59 = MULTIPLY(x58, v[87][i]); v[18][i] = x59;
    }
    if (HAS(loops, 62)) EACH {
        int64_t x0 = LESS(v[33][i], 0x0.0p+0);
        double x1 = MULTIPLY((x0 ? 1.0 : 0.0), 0x1.0000000000000p+1);
        double x2 = ADD(((v[120][i] != 0.0) ? 1.0 : 0.0), x1);
        int64_t x3 = LESS(v[122][i], v[34][i]);
        double x4 = MULTIPLY((x3 ? 1.0 : 0.0), 0x1.0000000000000p+3);
        double x5 = ADD(x2, x4);
        double x6 = ADD(x5, v[89][i]);
        int64_t x7 = LESS(v[2][i], 0x1.0000000000000p+26);
        int64_t x8 = NOT(x7);
        double x9 = MULTIPLY((x8 ? 1.0 : 0.0), 0x1.0000000000000p+5);
        double x10 = ADD(x6, x9);
        double x11 = ADD(v[62][i], v[65][i]);
        double x12 = ADD(x11, v[67][i]);
        double x13 = ADD(x12, v[74][i]);
        double x14 = ADD(x13, v[56][i]);
        double x15 = ADD(x14, v[57][i]);
        double x16 = ABSOLUTE(x15);
        int64_t x17 = LESS(x16, INFINITY);
        double x18 = MULTIPLY(0x1.0000000000000p-1, v[34][i]);
        double x19 = ADD(v[49][i], x18);
        double x20 = ABSOLUTE(x19);
        int64_t x21 = LESS(x20, INFINITY);
        int64_t x22 = BOTH(x17, x21);
        double x23 = DIVIDE(v[51][i], v[49][i]);
        double x24 = ABSOLUTE(x23);
        int64_t x25 = LESS(x24, INFINITY);
        int64_t x26 = BOTH(x22, x25);
        int64_t x27 = LESS_OR_EQUAL(v[2][i], INFINITY);
        int64_t x28 = BOTH(x26, x27);
        int64_t x29 = NOT(x28);
        double x30 = MULTIPLY((x29 ? 1.0 : 0.0), 0x1.0000000000000p+6);
        double x31 = ADD(x10, x30);
        double x32 = ADD(x31, v[125][i]);
        double x33 = ADD(x32, v[126][i]);
        double x34 = ADD(x33, v[127][i]);
        double x35 = ADD(x34, v[90][i]); v[26][i] = x35;
    }
    if (HAS(loops, 63)) EACH {
        double x0 = AGAINST(MU[i], v[8][i]); v[2][i] = x0;
    }
    if (HAS(loops, 64)) EACH {
        double x0 = NEGATIVE(v[13][i]); v[3][i] = x0;
    }
    if (HAS(loops, 65)) EACH {
        double x0 = MULTIPLY(0x1.0000000000000p-1, v[44][i]); v[6][i] = x0;
    }
    if (HAS(loops, 66)) EACH {
        double x0 = ABSOLUTE(0x1.0000000000000p+0); v[9][i] = x0;
    }
    if (HAS(loops, 67)) EACH {
        double x0 = MULTIPLY(E[i], v[13][i]); v[10][i] = x0;
        double x1 = NEGATIVE(x0); v[11][i] = x1;
        double x2 = ABSOLUTE(v[54][i]); v[14][i] = x2;
    }
    if (HAS(loops, 68)) EACH {
        double x0 = ADD(v[10][i], v[13][i]); v[15][i] = x0;
        double x1 = NEGATIVE(x0);
        double x2 = DIVIDE(x1, v[54][i]); v[16][i] = x2;
    }
    if (HAS(loops, 69)) EACH {
        double x0 = MULTIPLY(v[1][i], v[2][i]);
        double x1 = SUBTRACT(v[0][i], x0); v[17][i] = x1;
        double x2 = MULTIPLY(v[0][i], x1); v[18][i] = x2;
        double x3 = MULTIPLY(v[0][i], v[2][i]);
        double x4 = ADD(v[1][i], x3); v[19][i] = x4;
        double x5 = MULTIPLY(v[1][i], x4); v[20][i] = x5;
        double x6 = MULTIPLY(x2, x5);
        int64_t x7 = LESS(-0x1.0000000000000p-1, x6);
        double x8 = CHOOSE(x7, v[55][i], 0x0.0p+0); v[21][i] = x8;
        double x9 = MULTIPLY(x1, v[16][i]);
        double x10 = MULTIPLY(v[53][i], x9); v[22][i] = x10;
        double x11 = MULTIPLY(v[52][i], x9); v[23][i] = x11;
        double x12 = MULTIPLY(x4, v[16][i]); v[24][i] = x12;
    }
    if (HAS(loops, 70)) EACH {
        double x0 = MULTIPLY(v[52][i], v[24][i]); v[25][i] = x0;
    }
    if (HAS(loops, 71)) EACH {
        double x0 = MULTIPLY(v[21][i], v[18][i]);
        int64_t x1 = LESS(v[38][i], x0);
        double x2 = SUBTRACT(VX[i], v[22][i]);
        double x3 = MULTIPLY(v[5][i], v[20][i]);
        double x4 = SUBTRACT(v[11][i], v[12][i]);
        double x5 = MULTIPLY(v[17][i], x4);
        double x6 = ADD(x3, x5);
        double x7 = ADD(x2, x6);
        double x8 = ADD(UX[i], v[23][i]);
        double x9 = CHOOSE(x1, x7, x8); v[26][i] = x9;
        int64_t x10 = LESS(v[39][i], x0);
        double x11 = SUBTRACT(x8, x6);
        double x12 = CHOOSE(x10, x11, x2); v[27][i] = x12;
    }
    if (HAS(loops, 72)) EACH {
        double x0 = MULTIPLY(v[50][i], v[13][i]); v[12][i] = x0;
        double x1 = MULTIPLY(x0, v[16][i]); v[17][i] = x1;
    }
    if (HAS(loops, 73)) EACH {
        double x0 = MULTIPLY(v[2][i], v[16][i]); v[28][i] = x0;
    }
    if (HAS(loops, 74)) EACH {
        double x0 = MULTIPLY(v[2][i], v[15][i]);
        double x1 = SUBTRACT(v[8][i], x0);
        double x2 = MULTIPLY(v[54][i], x1);
        double x3 = DIVIDE(x2, v[54][i]);
        double x4 = ADD(v[8][i], x3);
        double x5 = MULTIPLY(v[28][i], x4); v[29][i] = x5;
        double x6 = ADD(v[17][i], x5); v[30][i] = x6;
    }
    if (HAS(loops, 75)) EACH {
        double x0 = MULTIPLY(0x1.9000000000000p+5, v[30][i]);
        double x1 = NEGATIVE(x0);
        double x2 = DIVIDE(x1, v[6][i]); v[15][i] = x2;
    }
    if (HAS(loops, 76)) EACH {
        double x0 = MULTIPLY(-0x1.0000000000000p-1, v[17][i]); v[31][i] = x0;
    }
    if (HAS(loops, 77)) EACH {
        double x0 = NEGATIVE(v[30][i]); v[17][i] = x0;
        int64_t x1 = LESS(x0, 0x0.0p+0);
        double x2 = CHOOSE(x1, 0x0.0p+0, x0);
        double x3 = SQRT(x2); v[32][i] = x3;
        double x4 = MULTIPLY(0x1.0000000000000p-1, x2);
        double x5 = SQRT(x4); v[33][i] = x5;
    }
    if (HAS(loops, 78)) EACH {
        double x0 = MULTIPLY(-0x1.0000000000000p-1, v[29][i]); v[34][i] = x0;
        double x1 = CHOOSE((v[60][i] != 0.0), v[32][i], v[33][i]);
        double x2 = MULTIPLY(x1, v[64][i]); v[35][i] = x2;
    }
    if (HAS(loops, 79)) EACH {
        double x0 = CHOOSE((v[80][i] != 0.0), v[32][i], v[33][i]);
        double x1 = MULTIPLY(x0, v[87][i]); v[29][i] = x1;
    }
    if (HAS(loops, 80)) EACH {
        double x0 = MULTIPLY(v[23][i], v[23][i]);
        double x1 = MULTIPLY(v[25][i], v[25][i]);
        double x2 = ADD(x0, x1);
        double x3 = SQRT(x2); v[32][i] = x3;
    }
    if (HAS(loops, 81)) EACH {
        double x0 = MULTIPLY(v[53][i], v[24][i]); v[23][i] = x0;
        double x1 = MULTIPLY(v[22][i], v[22][i]);
        double x2 = MULTIPLY(x0, x0);
        double x3 = ADD(x1, x2);
        double x4 = SQRT(x3); v[33][i] = x4;
    }
    if (HAS(loops, 82)) EACH {
        double x0 = MULTIPLY(v[21][i], v[20][i]);
        int64_t x1 = LESS(v[38][i], x0);
        double x2 = SUBTRACT(VY[i], v[23][i]);
        double x3 = MULTIPLY(v[4][i], v[18][i]);
        double x4 = SUBTRACT(v[11][i], v[7][i]);
        double x5 = MULTIPLY(v[19][i], x4);
        double x6 = ADD(x3, x5);
        double x7 = ADD(x2, x6);
        double x8 = ADD(UY[i], v[25][i]);
        double x9 = CHOOSE(x1, x7, x8); v[22][i] = x9;
        int64_t x10 = LESS(v[39][i], x0);
        double x11 = SUBTRACT(x8, x6);
        double x12 = CHOOSE(x10, x11, x2); v[24][i] = x12;
    }
    if (HAS(loops, 83)) EACH {
        double x0 = ABSOLUTE(v[2][i]); v[7][i] = x0;
        double x1 = ADD(0x1.0000000000000p+0, x0);
        double x2 = MULTIPLY(v[54][i], x1);
        double x3 = MULTIPLY(v[9][i], x2);
        double x4 = DIVIDE(x3, v[14][i]);
        double x5 = MULTIPLY(0x1.8000000000000p+1, x4); v[18][i] = x5;
    }
    if (HAS(loops, 84)) EACH {
        double x0 = MULTIPLY(v[26][i], v[26][i]);
        double x1 = MULTIPLY(v[22][i], v[22][i]);
        double x2 = ADD(x0, x1);
        double x3 = MULTIPLY(v[42][i], x2);
        double x4 = MULTIPLY(v[27][i], v[27][i]);
        double x5 = MULTIPLY(v[24][i], v[24][i]);
        double x6 = ADD(x4, x5);
        double x7 = MULTIPLY(v[43][i], x6);
        double x8 = ADD(x3, x7);
        double x9 = MULTIPLY(0x1.0000000000000p-1, x8); v[19][i] = x9;
        int64_t x10 = LESS_OR_EQUAL(0x0.0p+0, v[13][i]); v[20][i] = x10 ? 1.0 : 0.0;
        double x11 = MULTIPLY(0x1.19799812dea11p-39, v[6][i]); v[21][i] = x11;
        int64_t x12 = LESS(0x0.0p+0, 0x0.0p+0);
        double x13 = MULTIPLY((x12 ? 1.0 : 0.0), 0x1.0000000000000p+8); v[25][i] = x13;
        double x14 = MULTIPLY((x12 ? 1.0 : 0.0), 0x1.0000000000000p+9); v[36][i] = x14;
        int64_t x15 = LESS(0x0.0p+0, -0x1.0000000000000p+0);
        int64_t x16 = LESS(0x0.0p+0, 0x1.0000000000000p+0);
        int64_t x17 = LESS(0x1.0000000000000p+0, 0x0.0p+0);
        int64_t x18 = EITHER(x16, x17);
        int64_t x19 = BOTH(x12, x18);
        int64_t x20 = EITHER(x15, x19);
        double x21 = MULTIPLY((x20 ? 1.0 : 0.0), 0x1.0000000000000p+10); v[37][i] = x21;
    }
    if (HAS(loops, 85)) EACH {
        double x0 = MULTIPLY(v[1][i], v[10][i]);
        double x1 = MULTIPLY(v[54][i], x0); v[41][i] = x1;
        double x2 = MULTIPLY(v[0][i], v[10][i]);
        double x3 = MULTIPLY(v[54][i], x2); v[44][i] = x3;
        int64_t x4 = LESS(0x0.0p+0, v[14][i]); v[45][i] = x4 ? 1.0 : 0.0;
        double x5 = NEGATIVE(v[54][i]);
        double x6 = CHOOSE(x4, 0x0.0p+0, x5); v[46][i] = x6;
    }
    if (HAS(loops, 86)) EACH {
        double x0 = NEGATIVE(v[41][i]);
        double x1 = MULTIPLY(v[54][i], v[4][i]);
        double x2 = SUBTRACT(x0, x1); v[10][i] = x2;
        double x3 = NEGATIVE(v[44][i]);
        double x4 = MULTIPLY(v[54][i], v[5][i]);
        double x5 = SUBTRACT(x3, x4); v[47][i] = x5;
    }
    if (HAS(loops, 87)) EACH {
        double x0 = MULTIPLY(v[0][i], v[47][i]);
        double x1 = MULTIPLY(v[1][i], v[10][i]);
        double x2 = ADD(x0, x1); v[48][i] = x2;
    }
    if (HAS(loops, 88)) EACH {
        double x0 = MULTIPLY(v[0][i], v[10][i]);
        double x1 = MULTIPLY(v[1][i], v[47][i]);
        double x2 = SUBTRACT(x0, x1); v[49][i] = x2;
        double x3 = DIVIDE(x2, v[48][i]); v[50][i] = x3;
    }
    if (HAS(loops, 89)) EACH {
        int64_t x0 = LESS(v[16][i], 0x0.0p+0);
        double x1 = MULTIPLY((x0 ? 1.0 : 0.0), 0x1.0000000000000p+1);
        double x2 = ADD(((v[20][i] != 0.0) ? 1.0 : 0.0), x1);
        int64_t x3 = LESS(v[21][i], v[30][i]);
        double x4 = MULTIPLY((x3 ? 1.0 : 0.0), 0x1.0000000000000p+3);
        double x5 = ADD(x2, x4);
        double x6 = ADD(x5, v[89][i]);
        int64_t x7 = LESS(v[18][i], 0x1.0000000000000p+26);
        int64_t x8 = NOT(x7);
        double x9 = MULTIPLY((x8 ? 1.0 : 0.0), 0x1.0000000000000p+5);
        double x10 = ADD(x6, x9);
        double x11 = ADD(v[26][i], v[22][i]);
        double x12 = ADD(x11, v[27][i]);
        double x13 = ADD(x12, v[24][i]);
        double x14 = ADD(x13, WA[i]);
        double x15 = ADD(x14, WB[i]);
        double x16 = ABSOLUTE(x15);
        int64_t x17 = LESS(x16, INFINITY);
        double x18 = MULTIPLY(0x1.0000000000000p-1, v[30][i]);
        double x19 = ADD(v[6][i], x18);
        double x20 = ABSOLUTE(x19);
        int64_t x21 = LESS(x20, INFINITY);
        int64_t x22 = BOTH(x17, x21);
        double x23 = DIVIDE(v[17][i], v[6][i]);
        double x24 = ABSOLUTE(x23);
        int64_t x25 = LESS(x24, INFINITY);
        int64_t x26 = BOTH(x22, x25);
        int64_t x27 = LESS_OR_EQUAL(v[18][i], INFINITY);
        int64_t x28 = BOTH(x26, x27);
        int64_t x29 = NOT(x28);
        double x30 = MULTIPLY((x29 ? 1.0 : 0.0), 0x1.0000000000000p+6);
        double x31 = ADD(x10, x30);
        double x32 = ADD(x31, v[25][i]);
        double x33 = ADD(x32, v[36][i]);
        double x34 = ADD(x33, v[37][i]);
        int64_t x35 = LESS_OR_EQUAL(v[2][i], -0x1.4000000000000p+3);
        double x36 = MULTIPLY((x35 ? 1.0 : 0.0), 0x1.0000000000000p+11);
        double x37 = ADD(x34, x36);
        int64_t x38 = LESS(v[13][i], 0x0.0p+0);
        int64_t x39 = LESS(0x0.0p+0, v[16][i]);
        int64_t x40 = BOTH(x38, x39);
        int64_t x41 = LESS(v[54][i], 0x0.0p+0);
        double x42 = CHOOSE(x41, -0x1.0000000000000p+0, 0x1.0000000000000p+0);
        double x43 = MULTIPLY(v[48][i], x42);
        int64_t x44 = LESS(0x0.0p+0, x43);
        int64_t x45 = BOTH(x40, x44);
        double x46 = ABSOLUTE(v[49][i]);
        double x47 = MULTIPLY(v[49][i], x42);
        double x48 = NEGATIVE(x47);
        double x49 = AGAINST(v[2][i], x48);
        double x50 = SUBTRACT(x49, 0x1.12e0be826d695p-30);
        double x51 = MULTIPLY(x50, x43);
        int64_t x52 = LESS(x46, x51);
        int64_t x53 = BOTH(x45, x52);
        int64_t x54 = LESS(x49, -0x1.12e0be826d695p-30);
        int64_t x55 = BOTH(x40, x54);
        double x56 = MULTIPLY(0x1.12e0be826d695p-30, x43);
        int64_t x57 = LESS_OR_EQUAL(x46, x56);
        int64_t x58 = BOTH(x44, x57);
        int64_t x59 = BOTH(x55, x58);
        int64_t x60 = EITHER(x53, x59);
        int64_t x61 = LESS_OR_EQUAL(0x0.0p+0, 0x0.0p+0);
        double x62 = MULTIPLY(v[2][i], v[8][i]);
        int64_t x63 = LESS_OR_EQUAL(0x0.0p+0, x62);
        int64_t x64 = EITHER(x61, x63);
        double x65 = ADD(v[40][i], v[40][i]);
        int64_t x66 = LESS_OR_EQUAL(x65, 0x0.0p+0);
        int64_t x67 = LESS_OR_EQUAL(0x0.0p+0, x65);
        int64_t x68 = EITHER(x66, x67);
        int64_t x69 = EITHER(x64, x68);
        double x70 = SUBTRACT(v[7][i], 0x1.12e0be826d695p-30);
        double x71 = MULTIPLY(v[16][i], v[54][i]);
        double x72 = MULTIPLY(x70, x71);
        double x73 = SUBTRACT(x65, x72);
        int64_t x74 = LESS(x73, 0x0.0p+0);
        int64_t x75 = EITHER(x69, x74);
        double x76 = MULTIPLY(x73, x73);
        int64_t x77 = LESS(x76, 0x0.0p+0);
        int64_t x78 = EITHER(x75, x77);
        int64_t x79 = NOT(x78);
        int64_t x80 = NOT(x79);
        int64_t x81 = BOTH(x60, x80);
        double x82 = MULTIPLY((x81 ? 1.0 : 0.0), 0x1.0000000000000p+12);
        double x83 = ADD(x37, x82);
        int64_t x84 = NOT(x58);
        int64_t x85 = BOTH(x55, x84);
        int64_t x86 = LESS(0x0.0p+0, x46);
        int64_t x87 = BOTH(x85, x86);
        int64_t x88 = BOTH(x87, x80);
        double x89 = MULTIPLY((x88 ? 1.0 : 0.0), 0x1.0000000000000p+13);
        double x90 = ADD(x83, x89); v[23][i] = x90;
    }
    if (HAS(loops, 90)) EACH {
        double x0 = CHOOSE((v[45][i] != 0.0), v[39][i], UX[i]);
        double x1 = MULTIPLY(v[46][i], v[5][i]);
        double x2 = SUBTRACT(x1, v[44][i]);
        double x3 = DIVIDE(x2, v[54][i]);
        double x4 = MULTIPLY(v[38][i], x3);
        double x5 = ADD(x0, x4); v[2][i] = x5;
        double x6 = CHOOSE((v[45][i] != 0.0), v[39][i], VX[i]);
        double x7 = MULTIPLY(v[23][i], x3);
        double x8 = SUBTRACT(x6, x7); v[7][i] = x8;
    }
    if (HAS(loops, 91)) EACH {
        double x0 = CHOOSE((v[45][i] != 0.0), v[40][i], UY[i]);
        double x1 = MULTIPLY(v[46][i], v[4][i]);
        double x2 = SUBTRACT(x1, v[41][i]);
        double x3 = DIVIDE(x2, v[54][i]);
        double x4 = MULTIPLY(v[38][i], x3);
        double x5 = ADD(x0, x4); v[15][i] = x5;
        double x6 = CHOOSE((v[45][i] != 0.0), v[40][i], VY[i]);
        double x7 = MULTIPLY(v[23][i], x3);
        double x8 = SUBTRACT(x6, x7); v[16][i] = x8;
    }
    if (HAS(loops, 92)) EACH {
        double x0 = MULTIPLY(v[2][i], v[2][i]);
        double x1 = MULTIPLY(v[15][i], v[15][i]);
        double x2 = ADD(x0, x1);
        double x3 = MULTIPLY(v[42][i], x2);
        double x4 = MULTIPLY(v[7][i], v[7][i]);
        double x5 = MULTIPLY(v[16][i], v[16][i]);
        double x6 = ADD(x4, x5);
        double x7 = MULTIPLY(v[43][i], x6);
        double x8 = ADD(x3, x7);
        double x9 = MULTIPLY(0x1.0000000000000p-1, x8); v[17][i] = x9;
    }
    if (HAS(loops, 93)) EACH {
        double x0 = MULTIPLY(v[54][i], v[54][i]);
        double x1 = DIVIDE(v[47][i], x0); v[18][i] = x1;
        double x2 = DIVIDE(v[10][i], x0); v[22][i] = x2;
    }
    if (HAS(loops, 94)) EACH {
        double x0 = MULTIPLY(v[0][i], v[18][i]);
        double x1 = MULTIPLY(v[1][i], v[22][i]);
        double x2 = ADD(x0, x1); v[10][i] = x2;
        double x3 = MULTIPLY(v[12][i], x2); v[23][i] = x3;
    }
    if (HAS(loops, 95)) EACH {
        double x0 = MULTIPLY(v[0][i], v[22][i]);
        double x1 = MULTIPLY(v[1][i], v[18][i]);
        double x2 = SUBTRACT(x0, x1); v[12][i] = x2;
        double x3 = MULTIPLY(x2, v[8][i]); v[24][i] = x3;
    }
    if (HAS(loops, 96)) EACH {
        double x0 = MULTIPLY(-0x1.0000000000000p-1, v[23][i]); v[26][i] = x0;
        double x1 = MULTIPLY(-0x1.0000000000000p-1, v[24][i]); v[27][i] = x1;
    }
    if (HAS(loops, 97)) EACH {
        double x0 = SUBTRACT(v[2][i], v[7][i]);
        double x1 = ADD(v[5][i], x0);
        double x2 = MULTIPLY(v[18][i], x1);
        double x3 = ABSOLUTE(x2);
        double x4 = SUBTRACT(v[15][i], v[16][i]);
        double x5 = ADD(v[4][i], x4);
        double x6 = MULTIPLY(v[22][i], x5);
        double x7 = ABSOLUTE(x6);
        double x8 = ADD(x3, x7);
        double x9 = ABSOLUTE(v[23][i]);
        double x10 = ABSOLUTE(v[24][i]);
        double x11 = ADD(x9, x10);
        int64_t x12 = LESS(x8, x11);
        double x13 = ADD(x2, x6);
        double x14 = NEGATIVE(x13);
        double x15 = ADD(v[23][i], v[24][i]); v[28][i] = x15;
        double x16 = NEGATIVE(x15); v[29][i] = x16;
        double x17 = CHOOSE(x12, x14, x16);
        double x18 = MULTIPLY(0x1.9000000000000p+5, x17);
        double x19 = DIVIDE(x18, v[6][i]); v[30][i] = x19;
        int64_t x20 = LESS(x17, 0x0.0p+0);
        double x21 = CHOOSE(x20, 0x0.0p+0, x17);
        double x22 = SQRT(x21);
        double x23 = MULTIPLY(0x1.0000000000000p-1, x21);
        double x24 = SQRT(x23);
        double x25 = CHOOSE((v[60][i] != 0.0), x22, x24);
        double x26 = MULTIPLY(x25, v[64][i]); v[31][i] = x26;
        double x27 = CHOOSE((v[80][i] != 0.0), x22, x24);
        double x28 = MULTIPLY(x27, v[87][i]); v[32][i] = x28;
    }
    if (HAS(loops, 98)) EACH {
        double x0 = MULTIPLY(v[52][i], v[18][i]);
        double x1 = MULTIPLY(x0, x0);
        double x2 = MULTIPLY(v[52][i], v[22][i]);
        double x3 = MULTIPLY(x2, x2);
        double x4 = ADD(x1, x3);
        double x5 = SQRT(x4); v[4][i] = x5;
    }
    if (HAS(loops, 99)) EACH {
        double x0 = MULTIPLY(v[53][i], v[18][i]);
        double x1 = MULTIPLY(x0, x0);
        double x2 = MULTIPLY(v[53][i], v[22][i]);
        double x3 = MULTIPLY(x2, x2);
        double x4 = ADD(x1, x3);
        double x5 = SQRT(x4); v[5][i] = x5;
    }
    if (HAS(loops, 100)) EACH {
        double x0 = MULTIPLY(v[9][i], v[54][i]);
        double x1 = DIVIDE(x0, v[14][i]);
        double x2 = MULTIPLY(0x1.8000000000000p+1, x1); v[18][i] = x2;
    }
    if (HAS(loops, 101)) EACH {
        int64_t x0 = LESS(v[10][i], 0x0.0p+0);
        double x1 = MULTIPLY((x0 ? 1.0 : 0.0), 0x1.0000000000000p+1);
        double x2 = ADD(((v[20][i] != 0.0) ? 1.0 : 0.0), x1);
        int64_t x3 = LESS(v[21][i], v[28][i]);
        double x4 = MULTIPLY((x3 ? 1.0 : 0.0), 0x1.0000000000000p+3);
        double x5 = ADD(x2, x4);
        double x6 = ADD(x5, v[89][i]);
        int64_t x7 = LESS(v[18][i], 0x1.0000000000000p+26);
        int64_t x8 = NOT(x7);
        double x9 = MULTIPLY((x8 ? 1.0 : 0.0), 0x1.0000000000000p+5);
        double x10 = ADD(x6, x9);
        double x11 = ADD(v[2][i], v[15][i]);
        double x12 = ADD(x11, v[7][i]);
        double x13 = ADD(x12, v[16][i]);
        double x14 = ADD(x13, WA[i]);
        double x15 = ADD(x14, WB[i]);
        double x16 = ABSOLUTE(x15);
        int64_t x17 = LESS(x16, INFINITY);
        double x18 = MULTIPLY(0x1.0000000000000p-1, v[28][i]);
        double x19 = ADD(v[6][i], x18);
        double x20 = ABSOLUTE(x19);
        int64_t x21 = LESS(x20, INFINITY);
        int64_t x22 = BOTH(x17, x21);
        double x23 = DIVIDE(v[29][i], v[6][i]);
        double x24 = ABSOLUTE(x23);
        int64_t x25 = LESS(x24, INFINITY);
        int64_t x26 = BOTH(x22, x25);
        int64_t x27 = LESS_OR_EQUAL(v[18][i], INFINITY);
        int64_t x28 = BOTH(x26, x27);
        int64_t x29 = NOT(x28);
        double x30 = MULTIPLY((x29 ? 1.0 : 0.0), 0x1.0000000000000p+6);
        double x31 = ADD(x10, x30);
        double x32 = ADD(x31, v[25][i]);
        double x33 = ADD(x32, v[36][i]);
        double x34 = ADD(x33, v[37][i]);
        double x35 = ADD(x34, v[90][i]); v[9][i] = x35;
    }
}
