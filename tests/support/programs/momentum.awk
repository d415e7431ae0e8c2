# From the centre of mass of both: the impulse P is the change of A's momentum there. Three
# equations for Px, Py and the moment along x and y, by Cramer's rule.
function det(a, b, c, d, e, f, g, h, i) { return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) }
function cell(x) { return (x == x && x < 1e300 && x > -1e300) ? sprintf("%.17g", x) : "" }
BEGIN { FS = ","; PI = 3.14159265358979323846 }
{ sub(/\r$/, "") }
NR == 1 { for (i = 1; i <= NF; i++) where[$i] = i; print "VAX,VAY,VBX,VBY,WAF,WBF,PN,PT"; next }
{
    E = $where["E"] + 0; MU = $where["MU"] + 0; EM = $where["EM"] + 0; M = $where["M"] + 0
    DA = $where["DA"] + 0; DB = $where["DB"] + 0; G = $where["GA"] * PI / 180
    A = ($where["TA"] + $where["PA"]) * PI / 180; B = ($where["TB"] + $where["PB"]) * PI / 180
    MA = $where["MA"] + 0; MB = $where["MB"] + 0; IA = $where["IA"] + 0; IB = $where["IB"] + 0
    UX = $where["UX"] + 0; UY = $where["UY"] + 0; WA = $where["WA"] + 0
    VX = $where["VX"] + 0; VY = $where["VY"] + 0; WB = $where["WB"] + 0
    if (M == 4) { EM = 1; DA = DB = 0; IA = IB = 1 }
    if (MA <= 0 || MB <= 0 || IA <= 0 || IB <= 0) { print ",,,,,,,"; next }
    mass = MA * MB / (MA + MB)
    gx = (MA * UX + MB * VX) / (MA + MB); gy = (MA * UY + MB * VY) / (MA + MB)
    rx = UX - VX; ry = UY - VY
    ax = -DA * cos(A); ay = -DA * sin(A); bx = DB * cos(B); by = DB * sin(B)
    ux = rx - ay * WA + by * WB; uy = ry + ax * WA - bx * WB; dw = WA - WB
    # compliance along x and y and of the moment
    xx = 1 / mass + ay * ay / IA + by * by / IB
    xy = -ax * ay / IA - bx * by / IB
    yy = 1 / mass + ax * ax / IA + bx * bx / IB
    xm = -ay / IA - by / IB; ym = ax / IA + bx / IB; mm = 1 / IA + 1 / IB
    c = cos(G); s = sin(G)
    un = ux * c + uy * s; ut = uy * c - ux * s
    r11 = c * xx + s * xy; r12 = c * xy + s * yy; r13 = c * xm + s * ym; q1 = -(1 + E) * un
    if (MU == -10) { r21 = c * xy - s * xx; r22 = c * yy - s * xy; r23 = c * ym - s * xm; q2 = -ut }
    else {
        mu = ut > 0 ? -MU : MU
        r21 = -s - mu * c; r22 = c - mu * s; r23 = 0; q2 = 0
    }
    r31 = (1 - EM) * xm; r32 = (1 - EM) * ym; r33 = (1 - EM) * mm - EM * mm; q3 = -(1 - EM) * dw
    D = det(r11, r12, r13, r21, r22, r23, r31, r32, r33)
    if (D == 0) { print ",,,,,,,"; next }
    px = det(q1, r12, r13, q2, r22, r23, q3, r32, r33) / D
    py = det(r11, q1, r13, r21, q2, r23, r31, q3, r33) / D
    pm = M == 4 ? 0 : det(r11, r12, q1, r21, r22, q2, r31, r32, q3) / D
    rx += px / mass; ry += py / mass
    share = MB / (MA + MB)
    vax = gx + share * rx; vay = gy + share * ry
    vbx = gx - (1 - share) * rx; vby = gy - (1 - share) * ry
    waf = WA + (ax * py - ay * px + pm) / IA
    wbf = WB - (bx * py - by * px + pm) / IB
    print cell(vax) "," cell(vay) "," cell(vbx) "," cell(vby) "," cell(waf) "," cell(wbf) "," \
        cell(px * c + py * s) "," cell(py * c - px * s)
}
