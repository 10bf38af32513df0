# diffuse.awk - a matt surface that speaks the protocol's text form
#
# fault=short, long, words or more makes what it answers to eval no answer, half
# what it answers to sample.
BEGIN { pi = 3.14159265358979323846 }
$1 == "bands" { bands = $2 }
NF == 0 {
    print "bsdf 1\nformat text\nname matt, from awk"
    print "lobes diffuse_reflection\nparameter reflectance 0.5 everywhere\n"
    fflush()
}
$1 == "eval" || $1 == "pdf" || $1 == "sample" { op = $1; n = $2; next }
n > 0 && NF == 6 {
    if (op == "eval") {
        f = sprintf("%.17g", $3 > 0 && $6 > 0 ? 0.5 / pi : 0)
        line = f
        for (b = 1; b < bands; b++)
            line = line " " f
        if (fault == "short" && $6 > 0.9) line = f
        if (fault == "long" && $6 > 0.9) line = line " " f
        if (fault == "words" && $6 > 0.9) line = "a warning"
        if (fault == "more" && $6 > 0.9) line = line "\n" line
        print line
    } else if (op == "pdf") {
        printf "%.17g\n", ($3 > 0 && $6 > 0 ? $6 / pi : 0)
    } else {
        if ($3 > 0) {
            r = sqrt($4); phi = 2 * pi * $5; z = sqrt(1 - $4)
            line = sprintf("%.17g %.17g %.17g %.17g", r * cos(phi),
                           r * sin(phi), z, z / pi)
        } else {
            line = "0 0 0 0"
        }
        for (b = 0; b < bands; b++)
            line = line ($3 > 0 ? " 0.5" : " 0")
        print line (fault == "half" ? " 0.5" : " 0")
    }
    if (--n == 0)
        fflush()
}
