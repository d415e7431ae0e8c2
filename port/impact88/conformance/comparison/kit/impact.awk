# Reads the kit's vectors.csv, writes a table for impact88 compare.
#   awk -f impact.awk vectors.csv | impact88 compare -
function rad(degrees) { return degrees * atan2(0, -1) / 180 }
function show(x) { return x == x && x < 1e308 && x > -1e308 ? sprintf(",%.17g", x) : "," }
BEGIN { FS = "," }
{ sub(/\r$/, "") }
NR == 1 {
    for (i = 1; i <= NF; i++) at_[$i] = i
    print $0 ",VAX,VAY,VBX,VBY,WAF,WBF"
    next
}
{
    for (name in at_) g[name] = $(at_[name])
    point = g["M"] == 4
    MA = g["MA"] + 0; MB = g["MB"] + 0; IA = point ? 1 : g["IA"] + 0; IB = point ? 1 : g["IB"] + 0
    em = point ? 1 : g["EM"] + 0; da = point ? 0 : g["DA"] + 0; db = point ? 0 : g["DB"] + 0
    if (MA <= 0 || MB <= 0 || IA <= 0 || IB <= 0) { print $0 ",,,,,,"; next }
    a = rad(g["TA"] + g["PA"]); b = rad(g["TB"] + g["PB"]); c = cos(rad(g["GA"])); s = sin(rad(g["GA"]))
    an = da * (sin(a) * c - cos(a) * s); at = -da * (cos(a) * c + sin(a) * s)
    bn = db * (sin(b) * c - cos(b) * s); bt = -db * (cos(b) * c + sin(b) * s)
    dx = g["UX"] - g["VX"]; dy = g["UY"] - g["VY"]; w = g["WA"] - g["WB"]
    gn = dx * c + dy * s + an * g["WA"] + bn * g["WB"]; gt = dy * c - dx * s + at * g["WA"] + bt * g["WB"]
    # everything times 1 - 2 EM, so that EM = 1/2 is nothing special
    h = 1 - 2 * em; q = 1 - em; i = IA * IB / (IA + IB); kn = an / IA - bn / IB; kt = at / IA - bt / IB
    nn = h * (1 / MA + 1 / MB + an * an / IA + bn * bn / IB) - q * i * kn * kn
    nt = h * (an * at / IA + bn * bt / IB) - q * i * kn * kt
    tt = h * (1 / MA + 1 / MB + at * at / IA + bt * bt / IB) - q * i * kt * kt
    rn = -h * (1 + g["E"]) * gn + q * i * kn * w; rt = -h * gt + q * i * kt * w
    mu = gt > 0 ? -g["MU"] : g["MU"] + 0
    bottom = g["MU"] == -10 ? nn * tt - nt * nt : nn + mu * nt
    if (bottom == 0 || (h == 0 && !point)) { print $0 ",,,,,,"; next }
    if (g["MU"] == -10) { pn = (rn * tt - rt * nt) / bottom; pt = (rt * nn - rn * nt) / bottom }
    else { pn = rn / bottom; pt = mu * pn }
    m = point ? 0 : -q / h * i * (w + kn * pn + kt * pt)
    px = pn * c - pt * s; py = pn * s + pt * c
    print $0 show(g["UX"] + px / MA) show(g["UY"] + py / MA) show(g["VX"] - px / MB) \
        show(g["VY"] - py / MB) show(g["WA"] + (an * pn + at * pt + m) / IA) \
        show(g["WB"] + (bn * pn + bt * pt - m) / IB)
}
