# Radii of gyration and the reduced mass: what the masses seem to be at the contact, along n and t.
function rad(d) { return d * atan2(0, -1) / 180 }
function out(x) { return (x == x && x < 1e300 && x > -1e300) ? sprintf("%.17g", x) : "" }
BEGIN { FS = "," }
{ sub(/\r$/, "") }
NR == 1 { for (i = 1; i <= NF; i++) col[$i] = i; print "VAX,VAY,VBX,VBY,WAF,WBF"; next }
{
    for (k in col) v[k] = $(col[k]) + 0
    pm = (v["M"] == 4)
    if (v["MA"] <= 0 || v["MB"] <= 0 || (!pm && (v["IA"] <= 0 || v["IB"] <= 0))) { print ",,,,,"; next }
    ka2 = (pm ? 1 : v["IA"]) / v["MA"]; kb2 = (pm ? 1 : v["IB"]) / v["MB"]
    em = pm ? 1 : v["EM"]; dista = pm ? 0 : v["DA"]; distb = pm ? 0 : v["DB"]
    if (em == 0.5) { print ",,,,,"; next }
    th = rad(v["GA"]); nx = cos(th); ny = sin(th)
    alpha = rad(v["TA"] + v["PA"]) - th; beta = rad(v["TB"] + v["PB"]) - th
    # levers: ha and hb of the normal impulse, fa and fb of the tangential one
    ha = dista * sin(alpha); fa = -dista * cos(alpha)
    hb = -distb * sin(beta); fb = distb * cos(beta)
    una = v["UX"] * nx + v["UY"] * ny; uta = v["UY"] * nx - v["UX"] * ny
    unb = v["VX"] * nx + v["VY"] * ny; utb = v["VY"] * nx - v["VX"] * ny
    closing = (una + ha * v["WA"]) - (unb + hb * v["WB"])
    sliding = (uta + fa * v["WA"]) - (utb + fb * v["WB"])
    turning = v["WA"] - v["WB"]
    ma = v["MA"]; mb = v["MB"]
    # seeming masses
    seemn = (1 + ha * ha / ka2) / ma + (1 + hb * hb / kb2) / mb
    seemt = (1 + fa * fa / ka2) / ma + (1 + fb * fb / kb2) / mb
    mixed = ha * fa / (ka2 * ma) + hb * fb / (kb2 * mb)
    spinn = ha / (ma * ka2) + hb / (mb * kb2); spint = fa / (ma * ka2) + fb / (mb * kb2)
    spinm = 1 / (ma * ka2) + 1 / (mb * kb2)
    part = (1 - em) / (1 - 2 * em) / spinm
    seemn -= part * spinn * spinn; seemt -= part * spint * spint; mixed -= part * spinn * spint
    targetn = -(1 + v["E"]) * closing + part * spinn * turning
    targett = -sliding + part * spint * turning
    if (v["MU"] == -10) {
        d = seemn * seemt - mixed * mixed
        if (d == 0) { print ",,,,,"; next }
        in_ = (targetn * seemt - targett * mixed) / d; it = (targett * seemn - targetn * mixed) / d
    } else {
        f = sliding > 0 ? -v["MU"] : v["MU"]
        if (seemn + f * mixed == 0) { print ",,,,,"; next }
        in_ = targetn / (seemn + f * mixed); it = f * in_
    }
    couple = pm ? 0 : -part * (turning + spinn * in_ + spint * it)
    una += in_ / ma; uta += it / ma; unb -= in_ / mb; utb -= it / mb
    wa = v["WA"] + (ha * in_ + fa * it + couple) / (ma * ka2)
    wb = v["WB"] - (hb * in_ + fb * it + couple) / (mb * kb2)
    print out(una * nx - uta * ny) "," out(una * ny + uta * nx) "," out(unb * nx - utb * ny) "," \
        out(unb * ny + utb * nx) "," out(wa) "," out(wb)
}
