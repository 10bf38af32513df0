"""golden.py - what f, pdf and the Fresnel terms are, in fifty digits

    python3 tests/golden.py OUTDIR

writes OUTDIR/eval.tsv and OUTDIR/fresnel.tsv, which tests/test_golden.c holds
the library to.  It shares nothing with the library: every formula below comes
from the literature.  The tables depend on SEED only; mpmath computes all of
them, so no machine's libm is in them.

Conventions

    z is the surface normal, wo points to the viewer and wi to the light, both
    away from the surface; f [1/sr] is without the cosine, pdf [1/sr] is that of
    wi given wo.  Both are 0 unless wo.z > 0 and wi.z > 0.

    The six components in a row are doubles and are taken as exact, though as
    a vector they are a unit vector only to rounding.  What they stand for is

        cos_o = wo.z    cos_i = wi.z    h = (wo + wi) / |wo + wi|
        wi.h  = wo.h  = |wo + wi| / 2

    with sines from x and y as given.  For exact unit vectors the last line is
    an identity.  It is the definition here, because near grazing, where
    |wo + wi| is small, the rounding of a length to 1e-16 would change the
    product of wi and h by 1e-16 / |wo + wi|, and the half length by 1e-16 of
    itself.  A setting is the double nearest to its decimal text.

Formulas

    diffuse             f = reflectance / pi,  pdf = cos_i / pi

    roughconductor      f   = specular_reflectance F(wi.h) D(h) G2
                              / (4 cos_o cos_i)                         [1, 2]
      distribution      D   = P22(s) / h.z^4 / (alpha_u alpha_v), with
                        s   = (h.x / (h.z alpha_u), h.y / (h.z alpha_v))   [3]
        beckmann        P22 = exp(-s.s) / pi                               [4]
        ggx             P22 = 1 / (pi (1 + s.s)^2)                      [2, 5]
      masking, with Smith's Lambda [6] at
                        a   = w.z / sqrt(alpha_u^2 w.x^2 + alpha_v^2 w.y^2)
        beckmann        Lambda = (erf(a) - 1) / 2 + exp(-a^2) / (2 a sqrt(pi))
        ggx             Lambda = (-1 + sqrt(1 + 1 / a^2)) / 2              [3]
        correlated      G2  = 1 / (1 + Lambda(wo) + Lambda(wi))            [3]
        separable       G2  = G1(wo) G1(wi),  G1 = 1 / (1 + Lambda)
      sample_visible    pdf = G1(wo) D(h) / (4 cos_o)                      [7]
        or not          pdf = D(h) h.z / (4 wi.h)                          [2]
      fresnel           F as below: exact, approx, or schlick with
                        r0  = exact at normal incidence

    course_microfacet   f   = F G D / (4 cos_o cos_i)
                        D   = that of beckmann with alpha_u = alpha_v = alpha
                        G   = 1 / (1 + L(wi) + L(wo)), with
                        a   = 1 / (alpha tan(theta)) and
                        L   = (erf(a) - 1 + exp(-a^2) / (a X)) / 2
        lambda          X   = pi for course, sqrt(pi) for exact: only the
                              latter is Smith's
        fresnel_at      F   = approx at cos_i for normal, at wi.h for half
                        pdf = D(h) h.z / (4 wi.h)

Fresnel terms, unpolarised: F = (Rs + Rp) / 2, c the cosine of incidence

    conductor   n = eta + i k, q = sqrt(n^2 - 1 + c^2):                    [8]
                Rs = |(c - q) / (c + q)|^2,
                Rp = |(n^2 c - q) / (n^2 c + q)|^2
    dielectric  the same of a real n = eta, the index behind the surface over
                that in front: 1 beyond the critical angle
    approx      m = eta^2 + k^2, for large m:                              [9]
                Rs = (m - 2 eta c + c^2) / (m + 2 eta c + c^2),
                Rp = (m c^2 - 2 eta c + 1) / (m c^2 + 2 eta c + 1)
    schlick     F = r0 + (1 - r0) (1 - c)^5                               [10]

[1]  R. Cook and K. Torrance, A Reflectance Model for Computer Graphics, ACM
     TOG 1(1), 1982.
[2]  B. Walter, S. Marschner, H. Li and K. Torrance, Microfacet Models for
     Refraction through Rough Surfaces, EGSR 2007.
[3]  E. Heitz, Understanding the Masking-Shadowing Function in
     Microfacet-Based BRDFs, JCGT 3(2), 2014, sec. 5.
[4]  P. Beckmann and A. Spizzichino, The Scattering of Electromagnetic Waves
     from Rough Surfaces, Pergamon, 1963.
[5]  T. Trowbridge and K. Reitz, Average Irregularity Representation of a
     Rough Surface for Ray Reflection, JOSA 65(5), 1975.
[6]  B. Smith, Geometrical Shadowing of a Random Rough Surface, IEEE Trans.
     Antennas and Propagation 15(5), 1967.
[7]  E. Heitz and E. d'Eon, Importance Sampling Microfacet-Based BSDFs using
     the Distribution of Visible Normals, CGF 33(4), 2014.
[8]  M. Born and E. Wolf, Principles of Optics, 7th ed., 1999, sec. 1.5 and
     14.2.
[9]  M. Pharr and G. Humphreys, Physically Based Rendering, 2004, sec. 9.2.
[10] C. Schlick, An Inexpensive BRDF Model for Physically-based Rendering, CGF
     13(3), 1994.
"""

import itertools
import os
import random
import sys

from mpmath import mp, mpc, mpf

SEED = 20070614
DIGITS = 50
mp.dps = DIGITS
MAX_SLOPE2 = 16  # s.s of the half vector; further out nothing is tested


# -- Fresnel ------------------------------------------------------------------

def unpolarised(n2, c):
    """Of a medium with the squared relative index n2, real or complex."""
    q = mp.sqrt(n2 - 1 + c * c)
    rs = (c - q) / (c + q)
    rp = (n2 * c - q) / (n2 * c + q)
    return (abs(rs) ** 2 + abs(rp) ** 2) / 2


def conductor(c, eta, k):
    return unpolarised(mpc(eta, k) ** 2, c)


def dielectric(c, eta, _):
    return unpolarised(mpf(eta) ** 2, c)


def approx(c, eta, k):
    m = eta * eta + k * k
    rs = (m - 2 * eta * c + c * c) / (m + 2 * eta * c + c * c)
    rp = (m * c * c - 2 * eta * c + 1) / (m * c * c + 2 * eta * c + 1)
    return (rs + rp) / 2


def schlick(c, _, r0):
    return r0 + (1 - r0) * (1 - c) ** 5


FRESNEL = {
    "exact": conductor,
    "approx": approx,
    "schlick": lambda c, eta, k: schlick(c, None, conductor(mpf(1), eta, k)),
}


# -- microfacets --------------------------------------------------------------

def slope2(w, au, av):
    """s.s of the facet whose normal is along w, of any length."""
    return (w[0] / (w[2] * au)) ** 2 + (w[1] / (w[2] * av)) ** 2


P22 = {
    "beckmann": lambda s2: mp.exp(-s2) / mp.pi,
    "ggx": lambda s2: 1 / (mp.pi * (1 + s2) ** 2),
}


def lambda_beckmann(inv_a, x=None):
    """Smith's with x = sqrt(pi), which is the default."""
    if inv_a == 0:
        return mpf(0)
    a = 1 / inv_a
    x = x or mp.sqrt(mp.pi)
    return (mp.erf(a) - 1) / 2 + mp.exp(-a * a) / (2 * a * x)


LAMBDA = {
    "beckmann": lambda_beckmann,
    "ggx": lambda inv_a: (-1 + mp.sqrt(1 + inv_a ** 2)) / 2,
}


def inv_a(w, au, av):
    return mp.sqrt((au * w[0]) ** 2 + (av * w[1]) ** 2) / w[2]


def half(wo, wi):
    """The half vector and its cosine with either direction."""
    v = [o + i for o, i in zip(wo, wi)]
    length = mp.sqrt(sum(x * x for x in v))
    return [x / length for x in v], length / 2


# -- models: f of the three bands, and pdf ------------------------------------

def number(text):
    return mpf(float(text))


def bands(text):
    return [number(t) for t in text.split("/")]


def diffuse(s, wo, wi):
    return [rho / mp.pi for rho in bands(s["reflectance"])], wi[2] / mp.pi


def roughconductor(s, wo, wi):
    au = number(s.get("alpha_u", s.get("alpha")))
    av = number(s.get("alpha_v", s.get("alpha")))
    h, cos_h = half(wo, wi)
    d = P22[s["distribution"]](slope2(h, au, av)) / (au * av * h[2] ** 4)

    lam = LAMBDA[s["distribution"]]
    lo, li = lam(inv_a(wo, au, av)), lam(inv_a(wi, au, av))
    g2 = {"correlated": 1 / (1 + lo + li),
          "separable": 1 / ((1 + lo) * (1 + li))}[s["masking"]]

    f = [rho * FRESNEL[s["fresnel"]](cos_h, eta, k) * d * g2
         / (4 * wo[2] * wi[2])
         for rho, eta, k in zip(bands(s["specular_reflectance"]),
                                bands(s["eta"]), bands(s["k"]))]
    pdf = {"true": d / ((1 + lo) * 4 * wo[2]),
           "false": d * h[2] / (4 * cos_h)}[s["sample_visible"]]
    return f, pdf


def course_microfacet(s, wo, wi):
    alpha = number(s["alpha"])
    h, cos_h = half(wo, wi)
    d = P22["beckmann"](slope2(h, alpha, alpha)) / (alpha ** 2 * h[2] ** 4)

    x = {"course": +mp.pi, "exact": mp.sqrt(mp.pi)}[s["lambda"]]
    lo, li = (lambda_beckmann(inv_a(w, alpha, alpha), x) for w in (wo, wi))

    c = {"normal": wi[2], "half": cos_h}[s["fresnel_at"]]
    f = [approx(c, eta, k) * d / ((1 + lo + li) * 4 * wo[2] * wi[2])
         for eta, k in zip(bands(s["eta"]), bands(s["k"]))]
    return f, d * h[2] / (4 * cos_h)


MODELS = {"diffuse": diffuse, "roughconductor": roughconductor,
          "course_microfacet": course_microfacet}


def evaluate(spec, wo, wi):
    if not (wo[2] > 0 and wi[2] > 0):
        return [mpf(0)] * 4
    name, settings = spec.split(":")
    f, pdf = MODELS[name](dict(s.split("=") for s in settings.split(",")),
                          [mpf(x) for x in wo], [mpf(x) for x in wi])
    return f + [pdf]


# -- directions ---------------------------------------------------------------

def rounded(v):
    return tuple(float(x) for x in v)


def direction(cos, phi):
    """A unit vector in doubles."""
    sin = mp.sqrt((1 - cos) * (1 + cos))
    return rounded((sin * mp.cos(phi), sin * mp.sin(phi), cos))


COSINES = ([mp.cos(mp.radians(t)) for t in
            (0, 10, 20, 30, 40, 50, 60, 75, 85, 89, mpf("89.9"))]
           + [mpf("1e-4"), mpf("1e-8")])


def azimuth(rng):
    return 2 * mp.pi * mpf(rng.random())


def reflected(rng, wo, au, av, low, high):
    """wi above the surface, about a facet whose s.s is in [low, high) if such
    a facet turns up, and else in [0, MAX_SLOPE2)."""
    for attempt in itertools.count():
        if attempt == 40:
            low, high = 0, MAX_SLOPE2
        r = mp.sqrt(low + (high - low) * mpf(rng.random()))
        phi = azimuth(rng)
        n = [au * r * mp.cos(phi), av * r * mp.sin(phi), mpf(1)]
        t = 2 * sum(o * x for o, x in zip(wo, n)) / sum(x * x for x in n)
        wi = rounded(t * x - o for o, x in zip(wo, n))
        if wi[2] > 0 and slope2(half(wo, wi)[0], au, av) <= MAX_SLOPE2:
            return wi


def anywhere(rng, wo, au, av):
    """wi uniform over the hemisphere, as far as s.s allows."""
    while True:
        wi = direction(mpf(rng.random()), azimuth(rng))
        if wi[2] > 0 and slope2(half(wo, wi)[0], au, av) <= MAX_SLOPE2:
            return wi


# -- the rows -----------------------------------------------------------------

MATERIALS = [
    "eta=.18/.42/1.4,k=3.4/2.3/1.9",                             # as gold
    "eta=.29294/.28568/.28733,k=2.71809/2.34786/1.83329",        # calcium
    "eta=0/0/0,k=1/1/1",                                         # F = 1
]
ISOTROPIC = ["1e-4", "1e-3", ".01", ".1", ".25", ".5", "1"]
STRETCHED = [(".9", ".02"), (".5", ".001"), (".3", ".1")]


def shuffled(rng, *choices):
    """Every combination once in a random order, and so on for ever."""
    every = list(itertools.product(*choices))
    rng.shuffle(every)
    return itertools.cycle(every)


def rough_specs(rng, distribution):
    """(alpha_u, alpha_v, a function that makes the next spec)."""
    options = shuffled(rng, MATERIALS, ("true", "false"),
                       ("correlated", "separable"),
                       ("exact", "approx", "schlick"),
                       ("1/1/1", ".31/.47/.83"))

    def maker(alpha):
        def make():
            material, visible, masking, fresnel, rho = next(options)
            return (f"roughconductor:{material},{alpha},"
                    f"distribution={distribution},sample_visible={visible},"
                    f"masking={masking},fresnel={fresnel},"
                    f"specular_reflectance={rho}")
        return make

    for a in ISOTROPIC:
        yield number(a), number(a), maker(f"alpha={a}")
    for u, v in STRETCHED:
        yield number(u), number(v), maker(f"alpha_u={u},alpha_v={v}")


def course_specs(rng):
    options = shuffled(rng, MATERIALS, ("course", "exact"),
                       ("normal", "half"))

    def maker(alpha):
        def make():
            material, lam, at = next(options)
            return (f"course_microfacet:{material},alpha={alpha},"
                    f"lambda={lam},fresnel_at={at}")
        return make

    for a in ISOTROPIC:
        yield number(a), number(a), maker(a)


def microfacet_rows(rng, specs, repeat):
    """Around the lobe for every outgoing direction, and for the rougher ones
    anywhere."""
    count = len(COSINES) * repeat
    for au, av, spec in specs:
        # One stratum of s.s for each row, in a random order.
        strata = list(range(count))
        rng.shuffle(strata)
        for cos, stratum in zip(COSINES * repeat, strata):
            wo = direction(cos, azimuth(rng))
            low, high = (mpf(MAX_SLOPE2 * i) / count
                         for i in (stratum, stratum + 1))
            yield spec(), wo, reflected(rng, wo, au, av, low, high)
        if min(au, av) >= 0.25:
            for cos in COSINES[1::3]:
                wo = direction(cos, azimuth(rng))
                yield spec(), wo, anywhere(rng, wo, au, av)


def diffuse_rows(rng):
    for cos in COSINES:
        yield ("diffuse:reflectance=.17/.5/.83",
               direction(cos, azimuth(rng)),
               direction(mpf(rng.random()), azimuth(rng)))


def dark_rows(rng):
    """Either direction, or both, not above the surface."""
    specs = [f"roughconductor:{MATERIALS[0]},alpha=.25,distribution={d},"
             f"sample_visible={v},masking=correlated,fresnel=exact,"
             f"specular_reflectance=1/1/1"
             for d in ("beckmann", "ggx") for v in ("true", "false")]
    specs += [f"course_microfacet:{MATERIALS[1]},alpha=.1,lambda={x},"
              f"fresnel_at=half" for x in ("course", "exact")]
    specs += ["diffuse:reflectance=.17/.5/.83"]
    for spec in specs:
        for o, i in (".6", "-.3"), ("-.6", ".3"), ("-.6", "-.3"), (".6", "0"):
            yield (spec, direction(mpf(o), azimuth(rng)),
                   direction(mpf(i), azimuth(rng)))


def eval_rows():
    rng = random.Random(SEED)
    yield from diffuse_rows(rng)
    for distribution in ("beckmann", "ggx"):
        yield from microfacet_rows(rng, rough_specs(rng, distribution), 1)
    yield from microfacet_rows(rng, course_specs(rng), 2)
    yield from dark_rows(rng)


def fresnel_rows():
    """(kind, function, cosine, eta, k or r0)"""
    cosines = [float(c) for c in ("1e-8", "1e-4", ".0123", ".1", ".31", ".5",
                                  ".707", ".89", ".99", "1")]
    for kind, function in ("conductor", conductor), ("approx", approx):
        for eta, k in ((".18", "3.4"), ("1.4", "1.9"), (".29294", "2.71809"),
                       ("0", "1"), ("1", "1"), ("1.1", ".1"), ("1.5", "0"),
                       (".05", "40"), ("37", "1.2e3"), ("2.5", "1e-3")):
            for c in cosines:
                yield kind, function, c, eta, k
    for r0 in "0", ".04", ".31", ".97", "1":
        for c in cosines:
            yield "schlick", schlick, c, "0", r0
    for eta in "1.5", "1.3325", "2.42", "1.0003", "1", ".9997", ".75", ".4":
        n = number(eta)
        special = [1 / mp.sqrt(1 + n * n)]  # Brewster's angle
        if n < 1:
            critical = mp.sqrt(1 - n * n)
            special += [critical * (1 + sign * mpf(10) ** -e)
                        for sign in (-1, 1) for e in (15, 12, 9, 6, 3)]
        for c in sorted(cosines + [float(x) for x in special]):
            yield "dielectric", dielectric, c, eta, "0"


# -- the tables ---------------------------------------------------------------

def settled(function, *args):
    """The values in DIGITS digits, once twice as many have agreed on what is
    printed of them."""
    with mp.workdps(2 * DIGITS):
        check = function(*args)
    values = function(*args)
    for v, c in zip(values, check):
        assert abs(v - c) <= mpf(10) ** -25 * abs(c), args
    return values


def decimal(x):
    if x == 0:
        return "0"
    return mp.nstr(x, 20, strip_zeros=False, min_fixed=1, max_fixed=0)


def eval_table(out):
    out.write(f"""\
# f and pdf of the models, in twenty of fifty digits
# written by: python3 tests/golden.py OUTDIR, seed {SEED}
# formulas and their sources: the head of tests/golden.py
# made for this project; no measured data in it
# wo and wi: unit vectors rounded to double, taken as exact: cos_o = wo.z,
#   cos_i = wi.z, h along wo + wi, wi.h = |wo + wi| / 2
# slopes of h over alpha, squared: at most {MAX_SLOPE2}
# spec\two.x\two.y\two.z\twi.x\twi.y\twi.z\tf[0] [1/sr]\tf[1]\tf[2]\tpdf [1/sr]
""")
    for spec, wo, wi in eval_rows():
        values = settled(evaluate, spec, wo, wi)
        out.write("\t".join([spec] + [x.hex() for x in wo + wi]
                            + [decimal(v) for v in values]) + "\n")


def fresnel_table(out):
    out.write(f"""\
# unpolarised Fresnel reflectance, in twenty of fifty digits
# written by: python3 tests/golden.py OUTDIR
# formulas and their sources: the head of tests/golden.py
# made for this project; no measured data in it
# kind: conductor, approx, schlick or dielectric
# cos: cosine of incidence, taken as exact
# eta: index behind the surface over that in front; 0 where there is none
# k: of eta + i k; r0 for schlick; 0 for dielectric
# kind\tcos\teta\tk\tF [1]
""")
    for kind, function, c, eta, k in fresnel_rows():
        value, = settled(lambda: [function(mpf(c), number(eta), number(k))])
        out.write("\t".join([kind, c.hex(), eta, k, decimal(value)]) + "\n")


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: golden.py OUTDIR")
    for name, table in ("eval.tsv", eval_table), ("fresnel.tsv", fresnel_table):
        with open(os.path.join(sys.argv[1], name), "w", encoding="ascii",
                  newline="\n") as out:
            table(out)


if __name__ == "__main__":
    main()
