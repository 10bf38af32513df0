# numbers.awk - from what was measured to the numbers that the text names
#
#     awk -f numbers.awk settings.tsv constants.txt match.txt NAME.tsv...
#
# Writes numbers.tsv: every number of NAME.tsv as NAME.number, and what follows
# from them; and the tables of the curves, luminance.points and so on.

function say(name, value) { print name "\t" value >out }
function abs(x) { return x < 0 ? -x : x }
function both(a, b) {
    return sqrt(v[a, "luminance_error"]^2 + v[b, "luminance_error"]^2)
}
function word(yes, a, b) { return yes ? a : b }
function claim(name, holds) {
    say("claim." name, word(holds, "confirmed", "not confirmed"))
}
function point(file, curve, x, y, off) {
    printf "%s\t%s\t%.9g\t%.9g\n", curve, x, y, off >(file ".points")
}
function title(file, x, y) {
    print "curve\t" x "\t" y "\terror" >(file ".points")
}

BEGIN {
    FS = "\t"
    out = "numbers.tsv"
    print "name\tvalue" >out
    constants = split("etaR etaG etaB kR kG kB F0R F0G F0B off", constant, " ")
    parts = split("wall glass image roof spot", part, " ")
    about["wall"] = "a wall in the mirror sphere"
    about["glass"] = "within the glass sphere"
    about["image"] = "the glass sphere in the mirror"
    about["roof"] = "the ceiling in the mirror"
    about["spot"] = "the spot below the glass sphere"
    # From which bounce on they are seen, as the write-up has it.
    expected["wall"] = 2
    expected["glass"] = 3
    expected["image"] = 4
    expected["roof"] = 3
    alphas = split("0.005 0.05 0.25 0.5", alpha, " ")
}

FNR == 1 { from = FILENAME; sub(/\.[a-z]*$/, "", from) }

# Calcium: eta, k, F0, and how far the colour is off, by method.
from == "constants" {
    if ($0 ~ /^# source/) {
        page = $0
        sub(/.*\/ior\//, "", page)
        sub(/\.yml$/, "", page)
        say("ca.page", page)
    }
    method = $1 == "spectral" ? "spectral" : $1 ~ /nm$/ ? "fixed" : \
        $1 ~ /average/ ? "average" : $1 ~ /fit/ ? "fit" : ""
    for (i = 1; method != "" && i <= constants; i++)
        say("ca." method "." constant[i], $(1 + i))
    next
}

# Whose numbers the write-up's are.
from == "match" {
    if ($0 ~ /same numbers/)
        same_numbers = 1
    else if ($0 !~ /^#/) {
        pages[$1]
        say("match.page", $1)
        say("match.nm" ++matches, $2)
    }
    next
}

from == "settings" { say($1, $2); next }

{ say(from "." $1, $2); v[from, $1] = $2 + 0 }

# The spheres by M.
function by_depth(    m, before, d, e) {
    title("luminance", "bounces at most [1]", "mean luminance [W/(m² sr)]")
    for (m = 0; m <= 5; m++) {
        point("luminance", "the spheres", m, v["m" m, "luminance"], \
            v["m" m, "luminance_error"])
        if (m == 0)
            continue
        before = "m" (m - 1)
        d = v["m" m, "luminance"] - v[before, "luminance"]
        e = both("m" m, before)
        say("m" m ".more", d)
        say("m" m ".more_error", e)
        say("m" m ".share", v["b" m, "luminance"] / v["m100", "luminance"])
    }
    point("luminance", "100 bounces", "-", v["m100", "luminance"], 0)
    d = v["m100", "luminance"] - v["m5", "luminance"]
    e = both("m100", "m5")
    say("m100.more", d)
    say("m100.more_error", e)
    say("m100.brighter", d / v["m5", "luminance"])
    say("m100.sigma", e > 0 ? d / e : 0)
    say("m5.of_all", v["m5", "luminance"] / v["m100", "luminance"])
    say("m4.of_all", v["m4", "luminance"] / v["m100", "luminance"])
    say("m5.noise_ratio", v["m5", "noise"] / v["m4", "noise"])
    claim("noise_m5", v["m5", "noise"] < .95 * v["m4", "noise"])
    claim("m4_captures", v["m4", "luminance"] > .9 * v["m100", "luminance"])
    claim("m100_brighter", d > 3 * e)
}

# What the single bounces bring, in all and in parts of the picture.
function by_bounce(    b, i, p, sum, var, all, share, first, lit) {
    for (b = 0; b <= 5; b++) {
        sum += v["b" b, "luminance"]
        var += v["b" b, "luminance_error"]^2
    }
    say("bounces.sum", sum)
    say("bounces.error", sqrt(var))
    say("bounces.sigma", (sum - v["m5", "luminance"]) / \
        sqrt(var + v["m5", "luminance_error"]^2))
    title("bounces", "bounce [1]", "mean luminance [W/(m² sr)]")
    for (i = 1; i <= parts; i++) {
        p = part[i]
        all = 0
        first = lit = "none"
        for (b = 0; b <= 5; b++)
            all += v["b" b "-" p, "luminance"]
        for (b = 0; b <= 5; b++) {
            share = all > 0 ? v["b" b "-" p, "luminance"] / all : 0
            say("b" b "." p ".share", share)
            if (first == "none" && share >= .2)
                first = b
            if (lit == "none" && share > 0)
                lit = b
            if (share > 0)
                point("bounces", about[p], b, v["b" b "-" p, "luminance"], \
                    v["b" b "-" p, "luminance_error"])
        }
        say("first." p, first)
        say("lit." p, lit)
        say("about." p, about[p])
        if (p in expected)
            claim(p, first == expected[p])
    }
}

function adaptive(    m) {
    for (m = 5; m <= 100; m += 95)
        say("a" m ".share", v["a" m, "samples"] / v["a" m, "samples_most"])
    say("adaptive.sigma", (v["a5", "luminance"] - v["m5", "luminance"]) / \
        both("a5", "m5"))
    say("adaptive.off", v["a5", "luminance"] / v["m5", "luminance"] - 1)
    say("adaptive.more", v["a100", "samples"] / v["a5", "samples"] - 1)
    claim("rates", abs(v["a100", "samples"] / v["a5", "samples"] - 1) < .05)
}

# Gold by alpha: direct light as in the course, and by both ways of sampling.
function by_alpha(    i, a, name, mis, bright, calm, best, from) {
    title("noise", "alpha [1]", "noise of a pixel over its mean [1]")
    bright = calm = 1
    for (i = 1; i <= alphas; i++) {
        a = alpha[i]
        sub(/^0\./, "", a)
        name = "au" a "-mesh"
        mis = "mis" a "-mesh"
        point("noise", "light sampled", alpha[i], v[name, "noise"], 0)
        point("noise", "light and facets sampled", alpha[i], v[mis, "noise"], 0)
        say("mis" a ".ratio", v[name, "variance"] / v[mis, "variance"])
        if (i > 1) {
            if (v[mis, "luminance"] < v[from, "luminance"])
                bright = 0
            if (v[name, "noise"] > v[best, "noise"])
                calm = 0
        }
        from = mis
        best = name
    }
    say("alpha.brighter", v["mis5-mesh", "luminance"] / \
        v["mis005-mesh", "luminance"] - 1)
    say("alpha.calmer", v["au005-mesh", "noise"] / v["au5-mesh", "noise"])
    claim("brighter", bright)
    claim("calmer", calm)
}

function copper() {
    say("copper.ratio", 1 / v["cu-cosine-cu-importance", "variance_ratio"])
    say("copper.off", v["cu-cosine", "luminance"] / \
        v["cu-importance", "luminance"] - 1)
    say("copper.sigma", (v["cu-cosine", "luminance"] - \
        v["cu-importance", "luminance"]) / both("cu-cosine", "cu-importance"))
    say("copper.ratio_mesh", v["cu-cosine-mesh", "variance"] / \
        v["cu-importance-mesh", "variance"])
    say("copper.ratio_crop", v["crop-cosine", "variance"] / \
        v["crop-importance", "variance"])
    claim("importance", v["cu-cosine-cu-importance", "variance_ratio"] < 1)
}

function verdict(pair) {
    say(pair ".word", word(v[pair, "same"], \
        "estimates of one picture as far as can be told", "different pictures"))
}

END {
    by_depth()
    by_bounce()
    adaptive()
    by_alpha()
    copper()
    verdict("m4-m5")
    verdict("m5-m100")
    verdict("m5-a5")
    verdict("cu-cosine-cu-importance")
    say("match.word", word(same_numbers, "the same numbers when rounded", \
        "the nearest there are"))
}
