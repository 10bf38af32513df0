"""golden.py - what f, pdf, samples and Fresnel terms are, in fifty digits

    python3 tests/golden.py OUTDIR

writes eval.tsv, sample.tsv and fresnel.tsv there, which tests/test_golden.c
holds the library to.  It shares nothing with the library: every formula below
comes from the literature, and the faults of the course's models from their
description.  The tables depend on SEED only; mpmath computes all of them, so
no machine's libm is in them.

Conventions

    z is the surface normal, wo points to the viewer and wi to the light, both
    away from the surface; f [1/sr] is without the cosine, pdf [1/sr] is that of
    wi given wo.  Both are 0 unless wo.z > 0 and wi.z > 0, but for what has two
    sides: twosided, glass and refraction.

    The six components in a row are doubles and are taken as exact, though as
    a vector they are a unit vector only to rounding.  What they stand for is

        cos_o = wo.z    cos_i = wi.z    h = (wo + wi) / |wo + wi|
        wi.h  = wo.h  = |wo + wi| / 2

    with sines from x and y as given.  For exact unit vectors the last line is
    an identity.  It is the definition here, because near grazing, where
    |wo + wi| is small, the rounding of a length to 1e-16 would change the
    product of wi and h by 1e-16 / |wo + wi|, and the half length by 1e-16 of
    itself.  A setting is the double nearest to its decimal text.

    Where light is bent, h is along wo + n wi, whose terms nearly cancel for
    n near 1; so do those of wo.h and wi.h, which are the products as they
    stand, where either grazes the facet, those of 1 - F, and those of a root
    near the critical angle.  There a library can be right and yet not agree
    to 1e-12.  The tables have the change that one rounding in each of those
    steps makes: the step is done over with an error of 2^-53 of the terms
    that it sums, up and down, and the larger changes of all steps are added.

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

    roughdielectric     with n the index on the side of wi over that on the
                        side of wo, h.z > 0 and F(wo.h) exact;
                        n of F: the index behind the surface, seen from wo
      reflection        f   = specular_reflectance F D G2 / |4 cos_o cos_i|
                        pdf = F p / |4 wo.h|,  h along wo + wi
      transmission      f   = specular_transmittance (1 - F) D G2 |wo.h wi.h|
                              / (|cos_o cos_i| |wo + n wi|^2)            [2]
                        pdf = (1 - F) p n^2 |wi.h| / |wo + n wi|^2
                        h along wo + n wi; 0 unless wo is on the same side
                        of h as of the surface, and wi likewise
      sample_visible    p   = G1(wo) |wo.h| D / |cos_o|                  [7]
        or not          p   = D h.z
      masking           as above, but for transmission correlated is
                        G2  = B(1 + Lambda(wo), 1 + Lambda(wi)),
                        Euler's integral of u^Lambda(wo) (1-u)^Lambda(wi):
                        u, the share of heights below a point, is uniform [11]
      lobes             f and pdf of the other are 0
      int_ior = ext_ior there is no surface: both are 0

    [2] has (1 - F) D G2 |wo.h wi.h| n_o^2 / (|cos_o cos_i| (n_i wi.h + n_o
    wo.h)^2) in its eq. 21, the ratio of the radiance leaving along wo to the
    irradiance from wi, so the n^2 by which refraction concentrates radiance
    is in it; and |wo + n wi| is |wo.h + n wi.h|.  Its eq. 17 with the parts of
    wo and wi exchanged gives the n^2 |wi.h| / |wo + n wi|^2 of the pdf.

    blendbsdf           f   = (1 - weight) f_0 + weight f_1, pdf likewise
    twosided            front, or with both z negated back, which is front if
                        not given

Samples of one direction or two; "reflected" is (-wo.x, -wo.y, wo.z), and
"refracted" (-wo.x / n, -wo.y / n, -+sqrt(n^2 - 1 + cos_o^2) / n).  A branch has
a share of the draws, which is its pdf, and a weight f |cos_i| / pdf.  Shares of
u.z in [0, 1) are in the order given here; what is missing is absorbed.  R is
the exact F of |cos_o|, T = 1 - R, and radiance is scaled by 1 / n^2.

    mirror              reflected: 1, weight reflectance
    conductor           reflected: 1, weight F specular_reflectance
    refraction          refracted: 1, weight specular_transmittance / n^2;
                        beyond the critical angle absorbed
    dielectric          reflected: R, weight specular_reflectance
                        refracted: T, weight specular_transmittance / n^2
      fresnel           schlick: R of that, at the cosine in the thinner
                        medium, with r0 = ((n - 1) / (n + 1))^2
      lobes             the other is absorbed
    thindielectric      reflected: 2 R / (1 + R), weight specular_reflectance
                        -wo: the rest, weight specular_transmittance
                        n = int_ior / ext_ior from either side
    course_mirror       reflected: 1, weight reflectance
      over_cos=false    weight reflectance cos_o
    course_refraction   as refraction, of transmittance and n = ior or 1 / ior
      factor=course     weight transmittance n^2
    course_glass        as dielectric with schlick, and course_refraction
      schlick_at=inside R at |cos_o| on either side

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
[11] E. Heitz, J. Hanika, E. d'Eon and C. Dachsbacher, Multiple-Scattering
     Microfacet BSDFs with the Smith Model, ACM TOG 35(4), 2016.
"""

import itertools
import os
import random
import sys

from mpmath import mp, mpc, mpf

SEED = 20070614
DIGITS = 50
mp.dps = DIGITS
ROUNDING = mpf(2) ** -53
MAX_SLOPE2 = 16  # s.s of the half vector; further out nothing is tested


# -- Fresnel ------------------------------------------------------------------

def unpolarised(n2, c, off=0):
    """Of a medium with the squared relative index n2, real or complex; q^2 may
    be off."""
    q = mp.sqrt(n2 - 1 + c * c + off)
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

def split(text, at):
    """At every such character that is not in parentheses."""
    parts, depth = [""], 0
    for char in text:
        depth += (char == "(") - (char == ")")
        if char == at and depth == 0:
            parts.append("")
        else:
            parts[-1] += char
    return parts


def parsed(spec):
    """(name, settings); the spec of a model inside has no parentheses."""
    name, settings = spec.split(":", 1)
    pairs = (s.split("=", 1) for s in split(settings, ","))
    return name, {key: value[1:-1] if value[0] == "(" else value
                  for key, value in pairs}


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


DARK = [mpf(0)] * 3, mpf(0)


def one_sided(model):
    def on_two(s, wo, wi, *_):
        if wo[2] > 0 and wi[2] > 0:
            return model(s, wo, wi)
        return DARK
    return on_two


def relative_index(s, wo):
    """Of the medium that wo is not in, over that of wo."""
    above, below = number(s["ext_ior"]), number(s["int_ior"])
    return below / above if wo[2] > 0 else above / below


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def size(v):
    return [abs(x) for x in v]


STEPS = ("sum x", "sum y", "sum z", "wo.h", "wi.h", "q^2", "F", "Lambda(wo)",
         "Lambda(wi)")


def roughdielectric(s, wo, wi, off=(None, 0)):
    """off: one of STEPS, and by how many roundings."""
    def step(name, value, terms):
        return value + (off[1] * ROUNDING * terms if off[0] == name else 0)

    au = number(s.get("alpha_u", s.get("alpha")))
    av = number(s.get("alpha_v", s.get("alpha")))
    n = relative_index(s, wo)
    reflects = wo[2] * wi[2] > 0
    if n == 1 or s["lobes"] == ("transmission" if reflects else "reflection"):
        return DARK

    if reflects:
        h, cos_h = half(wo, wi)
    else:
        terms = [o + n * i for o, i in zip(size(wo), size(wi))]
        h = [step("sum " + j, o + n * i, t)
             for j, o, i, t in zip("xyz", wo, wi, terms)]
        length = mp.sqrt(dot(h, h))
        h = [x / length for x in h]
        terms = [t / length for t in terms]
        wo_h = step("wo.h", dot(wo, h), dot(size(wo), terms))
        wi_h = step("wi.h", dot(wi, h), dot(size(wi), terms))
        if h[2] < 0:
            wo_h, wi_h = -wo_h, -wi_h
        if wo_h * wo[2] <= 0 or wi_h * wi[2] <= 0:
            return DARK
        cos_h, cos_hi = abs(wo_h), abs(wi_h)

    refl = unpolarised(n * n, cos_h, step("q^2", 0, 1 + n * n))
    refl = step("F", refl, refl)
    d = P22[s["distribution"]](slope2(h, au, av)) / (au * av * h[2] ** 4)

    cos_o, cos_i = abs(wo[2]), abs(wi[2])
    lam = LAMBDA[s["distribution"]]
    lo = lam(abs(inv_a(wo, au, av)))
    li = lam(abs(inv_a(wi, au, av)))
    lo, li = step("Lambda(wo)", lo, lo), step("Lambda(wi)", li, li)
    if s["masking"] == "separable":
        g2 = 1 / ((1 + lo) * (1 + li))
    else:
        g2 = 1 / (1 + lo + li) if reflects else mp.beta(1 + lo, 1 + li)

    p = {"true": d * cos_h / ((1 + lo) * cos_o),
         "false": d * abs(h[2])}[s["sample_visible"]]
    if reflects:
        f = refl * d * g2 / (4 * cos_o * cos_i)
        return ([rho * f for rho in bands(s["specular_reflectance"])],
                refl * p / (4 * cos_h))
    f = (1 - refl) * d * g2 * cos_h * cos_hi / (cos_o * cos_i * length ** 2)
    return ([tau * f for tau in bands(s["specular_transmittance"])],
            (1 - refl) * p * n * n * cos_hi / length ** 2)


def blendbsdf(s, wo, wi, off):
    w = number(s["weight"])
    (f0, p0), (f1, p1) = (scattered(s[key], wo, wi, off)
                          for key in ("bsdf_0", "bsdf_1"))
    return ([(1 - w) * a + w * b for a, b in zip(f0, f1)],
            (1 - w) * p0 + w * p1)


def flipped(w):
    return (w[0], w[1], -w[2])


def twosided(s, wo, wi, off):
    if wo[2] < 0:
        return scattered(s.get("back", s["front"]), flipped(wo), flipped(wi),
                         off)
    return scattered(s["front"], wo, wi, off)


MODELS = {"diffuse": one_sided(diffuse),
          "roughconductor": one_sided(roughconductor),
          "course_microfacet": one_sided(course_microfacet),
          "roughdielectric": roughdielectric,
          "blendbsdf": blendbsdf, "twosided": twosided}


def scattered(spec, wo, wi, off):
    name, settings = parsed(spec)
    return MODELS[name](settings, wo, wi, off)


def change(value, others, unit=1):
    """The largest, in units; 0 where it is no more than the square of one."""
    most = max(abs(x - value) for x in others)
    return most / unit if most > mpf(10) ** -30 * unit else mpf(0)


def evaluate(spec, wo, wi):
    """f of the three bands, pdf, and what roundings may change f and pdf by,
    relative to what they are."""
    wo, wi = [mpf(x) for x in wo], [mpf(x) for x in wi]
    f, pdf = scattered(spec, wo, wi, (None, 0))
    changes = [mpf(0), mpf(0)]
    if "roughdielectric" in spec:
        for name in STEPS:
            both = [scattered(spec, wo, wi, (name, sign)) for sign in (-1, 1)]
            changes[0] += max(change(f[b], [x[0][b] for x in both], f[b])
                              for b in range(3))
            changes[1] += change(pdf, [x[1] for x in both], pdf)
    return f + [pdf] + changes


# -- models of one direction or two: their branches ---------------------------
# A branch is (share, wi, weight of the three bands), and one that is absorbed
# (share, None, None).  off: by how many roundings q^2 is.

def absorbed(share):
    return share, None, None


def reflection(wo, share, weight):
    return share, [-wo[0], -wo[1], wo[2]], weight


def q_squared(wo, n, off):
    return n * n - 1 + wo[2] ** 2 + off * ROUNDING * (1 + n * n)


def refraction(wo, n, share, weight, off):
    q2 = q_squared(wo, n, off)
    if q2 < 0:
        return absorbed(share)
    z = mp.sqrt(q2) / n
    return share, [-wo[0] / n, -wo[1] / n, -z if wo[2] > 0 else z], weight


def exact_share(wo, n, off):
    return unpolarised(n * n, abs(wo[2]), off * ROUNDING * (1 + n * n)) \
        if q_squared(wo, n, off) > 0 else mpf(1)


def schlick_share(wo, n, off, cosine="thinner"):
    q2 = q_squared(wo, n, off)
    if q2 < 0:
        return mpf(1)
    c = abs(wo[2]) if n > 1 or cosine == "inside" else mp.sqrt(q2) / n
    return schlick(c, None, ((n - 1) / (n + 1)) ** 2)


def mirror(s, wo, _):
    if wo[2] <= 0:
        return [absorbed(mpf(1))]
    return [reflection(wo, mpf(1), bands(s["reflectance"]))]


def smooth_conductor(s, wo, _):
    if wo[2] <= 0:
        return [absorbed(mpf(1))]
    return [reflection(wo, mpf(1), [
        rho * conductor(wo[2], eta, k)
        for rho, eta, k in zip(bands(s["specular_reflectance"]),
                               bands(s["eta"]), bands(s["k"]))])]


def smooth_refraction(s, wo, off):
    n = relative_index(s, wo)
    return [refraction(wo, n, mpf(1), [
        tau / n ** 2 for tau in bands(s["specular_transmittance"])], off)]


def smooth_dielectric(s, wo, off):
    n = relative_index(s, wo)
    r = {"exact": exact_share,
         "schlick": schlick_share}[s["fresnel"]](wo, n, off)
    up = reflection(wo, r, bands(s["specular_reflectance"]))
    down = refraction(wo, n, 1 - r, [
        tau / n ** 2 for tau in bands(s["specular_transmittance"])], off)
    if s["lobes"] == "reflection":
        down = absorbed(1 - r)
    if s["lobes"] == "transmission":
        up = absorbed(r)
    return [up, down]


def thindielectric(s, wo, off):
    n = number(s["int_ior"]) / number(s["ext_ior"])
    r = exact_share(wo, n, off)
    r = 2 * r / (1 + r)
    return [reflection(wo, r, bands(s["specular_reflectance"])),
            (1 - r, [-x for x in wo], bands(s["specular_transmittance"]))]


def course_mirror(s, wo, _):
    if wo[2] <= 0:
        return [absorbed(mpf(1))]
    cos = {"true": 1, "false": wo[2]}[s["over_cos"]]
    return [reflection(wo, mpf(1), [rho * cos
                                    for rho in bands(s["reflectance"])])]


def course_index(s, wo):
    """n, and the weights of what is refracted."""
    n = number(s["ior"]) if wo[2] > 0 else 1 / number(s["ior"])
    scale = {"course": n ** 2, "right": 1 / n ** 2}[s["factor"]]
    return n, [scale * tau for tau in bands(s["transmittance"])]


def course_refraction(s, wo, off):
    n, weight = course_index(s, wo)
    return [refraction(wo, n, mpf(1), weight, off)]


def course_glass(s, wo, off):
    n, weight = course_index(s, wo)
    r = schlick_share(wo, n, off, s["schlick_at"])
    return [reflection(wo, r, bands(s["reflectance"])),
            refraction(wo, n, 1 - r, weight, off)]


def two_smooth_sides(s, wo, off):
    if wo[2] > 0:
        return branches(s["front"], wo, off)
    return [(share, wi and list(flipped(wi)), weight) for share, wi, weight
            in branches(s.get("back", s["front"]), flipped(wo), off)]


SMOOTH = {"mirror": mirror, "conductor": smooth_conductor,
          "refraction": smooth_refraction, "dielectric": smooth_dielectric,
          "thindielectric": thindielectric, "course_mirror": course_mirror,
          "course_refraction": course_refraction,
          "course_glass": course_glass, "twosided": two_smooth_sides}


def branches(spec, wo, off):
    name, settings = parsed(spec)
    return SMOOTH[name](settings, wo, off)


def sampled(spec, wo):
    """Of each branch that is drawn at all: where its u.z begins and ends, wi,
    pdf, weights, and what roundings may change wi.z and a share by."""
    wo = [mpf(x) for x in wo]
    begin, rows = mpf(0), []
    here, low, high = (branches(spec, wo, off) for off in (0, -1, 1))
    for (share, wi, weight), *other in zip(here, low, high):
        end = begin + share
        if abs(share) > mpf(10) ** -30:
            turn = change(wi[2], [x[1][2] for x in other]) if wi else mpf(0)
            rows.append([begin, end] + (wi + [share] + weight if wi else
                                        [mpf(0)] * 7)
                        + [turn, change(share, [x[0] for x in other])])
        begin = end
    assert abs(begin - 1) < mpf(10) ** -30
    rows[-1][1] = mpf(1)
    return rows


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


GLASS = ["int_ior=1.5,ext_ior=1", "int_ior=1,ext_ior=1.5",
         "int_ior=1.05,ext_ior=1", "int_ior=2.4,ext_ior=1"]
TINTS = ["specular_reflectance=1/1/1,specular_transmittance=1/1/1",
         "specular_reflectance=.31/.47/.83,specular_transmittance=.9/.62/.2"]
SMOOTH_ENOUGH = ["1e-3", ".01", ".1", ".3", "1"]


def glass_makers(rng, distribution):
    """(alpha_u, alpha_v, a function that makes the next spec)."""
    options = shuffled(rng, GLASS, ("true", "false"),
                       ("correlated", "separable"), TINTS)

    def maker(alpha):
        def make(indices=None):
            glass, visible, masking, tint = next(options)
            return (f"roughdielectric:{indices or glass},{alpha},"
                    f"distribution={distribution},sample_visible={visible},"
                    f"masking={masking},{tint},lobes=both")
        return make

    for a in SMOOTH_ENOUGH:
        yield number(a), number(a), maker(f"alpha={a}")
    for u, v in STRETCHED[0], STRETCHED[2]:
        yield number(u), number(v), maker(f"alpha_u={u},alpha_v={v}")


def facet(rng, au, av, low, high):
    """A unit normal whose s.s is in [low, high)."""
    r = mp.sqrt(low + (high - low) * mpf(rng.random()))
    phi = azimuth(rng)
    m = [au * r * mp.cos(phi), av * r * mp.sin(phi), mpf(1)]
    length = mp.sqrt(dot(m, m))
    return [x / length for x in m]


def reflected_at(wo, m):
    t = 2 * dot(wo, m)
    return rounded(t * x - o for o, x in zip(wo, m))


def refracted_at(wo, m, n):
    """None beyond the critical angle."""
    c = dot(wo, m)
    q2 = n * n - 1 + c * c
    if q2 <= 0:
        return None
    q = mp.sqrt(q2) if c > 0 else -mp.sqrt(q2)
    return rounded((c * x - o - q * x) / n for o, x in zip(wo, m))


def representable(value):
    """Neither absent nor so small that a double cannot hold it."""
    return all(abs(x) > mpf("1e-250") for x in value[:4])


def scattered_row(rng, spec, wo, au, av, low, high, through):
    """A row about a facet whose s.s is in [low, high) if there is one that
    does it, and else in [0, MAX_SLOPE2); none if no facet does."""
    n = relative_index(parsed(spec)[1], wo)
    for attempt in range(200):
        if attempt == 40:
            low, high = 0, MAX_SLOPE2
        m = facet(rng, au, av, low, high)
        if dot(wo, m) * wo[2] <= 0:
            continue
        wi = refracted_at(wo, m, n) if through else reflected_at(wo, m)
        if (wi and (wi[2] * wo[2] < 0) == through
                and representable(evaluate(spec, wo, wi))):
            yield spec, wo, wi
            return


def glass_lobe_rows(rng, distribution):
    """Around both lobes for every wo on either side."""
    for au, av, spec in glass_makers(rng, distribution):
        cases = list(itertools.product(COSINES[::2], (1, -1), (False, True)))
        strata = list(range(len(cases)))
        rng.shuffle(strata)
        for (cos, side, through), i in zip(cases, strata):
            wo = direction(side * cos, azimuth(rng))
            yield from scattered_row(rng, spec(), wo, au, av,
                                     mpf(MAX_SLOPE2 * i) / len(cases),
                                     mpf(MAX_SLOPE2 * (i + 1)) / len(cases),
                                     through)


def facing(rng, m, c):
    """A unit vector that makes the cosine c with the unit vector m."""
    u = [m[2], mpf(0), -m[0]]
    length = mp.sqrt(dot(u, u))
    u = [x / length for x in u]
    v = [m[1] * u[2] - m[2] * u[1], m[2] * u[0] - m[0] * u[2],
         m[0] * u[1] - m[1] * u[0]]
    phi, sin = azimuth(rng), mp.sqrt(1 - c * c)
    return rounded(c * x + sin * (mp.cos(phi) * y + mp.sin(phi) * z)
                   for x, y, z in zip(m, u, v))


def glass_steep_rows(rng, distribution, repeat):
    """Facets that wo sees at the critical angle, nearly, and at grazing."""
    offsets = [sign * mpf(10) ** -e for e in (3, 6, 9) for sign in (1, -1)]
    for au, av, spec in glass_makers(rng, distribution):
        if au not in (number(".01"), number(".3")):
            continue
        cases = ([("critical", x) for x in offsets]
                 + [("grazing", mpf(10) ** -e) for e in (2, 4, 6)])
        for (kind, x), through, side in itertools.product(
                cases * repeat, (False, True), (1, -1)):
            text = spec()
            n = relative_index(parsed(text)[1], (0, 0, side))
            if kind == "critical":
                if n > 1:
                    continue
                x = mp.sqrt(1 - n * n) * (1 + x)
            for _ in range(200):
                m = [side * y for y in facet(rng, au, av, 0, 4)]
                wo = facing(rng, m, x)
                wi = refracted_at(wo, m, n) if through else reflected_at(wo, m)
                if (wi and wo[2] * side > 0
                        and (wi[2] * side < 0) == through
                        and representable(evaluate(text, wo, wi))):
                    yield text, wo, wi
                    break


def glass_wide_rows(rng, distribution):
    """Any two directions on opposite sides; often no facet joins them."""
    for au, av, spec in glass_makers(rng, distribution):
        for side in (1, -1) * 4 if min(au, av) >= 0.3 else ():
            wo = direction(side * mpf(rng.random()), azimuth(rng))
            for _ in range(200):
                text = spec()
                wi = direction(-side * mpf(rng.random()), azimuth(rng))
                n = relative_index(parsed(text)[1], wo)
                h = [o + n * i for o, i in zip(wo, wi)]
                if slope2(h, au, av) <= MAX_SLOPE2:
                    yield text, wo, wi
                    break


def glass_part_rows(rng, distribution):
    """One of the two lobes alone, and no surface at all."""
    for au, av, spec in list(glass_makers(rng, distribution))[2:4]:
        for lobes, side, through in itertools.product(
                ("reflection", "transmission"), (1, -1), (False, True)):
            wo = direction(side * mpf(".8"), azimuth(rng))
            for text, _, wi in scattered_row(rng, spec(), wo, au, av, 0, 4,
                                             through):
                yield text.removesuffix("both") + lobes, wo, wi
        for side, other in itertools.product((1, -1), repeat=2):
            yield (spec("int_ior=1.33,ext_ior=1.33"),
                   direction(side * mpf(".8"), azimuth(rng)),
                   direction(other * mpf(".81"), azimuth(rng)))


ROUGH = ("roughconductor:eta=.18/.42/1.4,k=3.4/2.3/1.9,alpha=.3,"
         "distribution={},sample_visible=true,masking=correlated,"
         "fresnel=exact,specular_reflectance=1/1/1")
FROSTED = ("roughdielectric:int_ior=1.5,ext_ior=1,alpha=.3,distribution={},"
           "sample_visible=false,masking=correlated," + TINTS[1]
           + ",lobes=both")
MATT, DARKER = "diffuse:reflectance=.17/.5/.83", "diffuse:reflectance=.1/.2/.3"


def nested_rows(rng):
    """Two models in one, on every pair of sides."""
    rough, other = ROUGH.format("ggx"), ROUGH.format("beckmann")
    frosted = FROSTED.format("ggx")
    two = f"twosided:front=({rough}),back=({MATT})"
    mixed = f"blendbsdf:weight=.3,bsdf_0=({MATT}),bsdf_1=({rough})"
    specs = [two, f"twosided:front=({other})", f"twosided:front=({mixed})",
             mixed, f"blendbsdf:weight=.85,bsdf_0=({MATT}),bsdf_1=({frosted})",
             f"blendbsdf:weight=.4,bsdf_0=({two}),bsdf_1=({frosted})",
             f"blendbsdf:weight=0,bsdf_0=({MATT}),bsdf_1=({DARKER})",
             f"blendbsdf:weight=1,bsdf_0=({MATT}),bsdf_1=({DARKER})"]
    a = number(".3")
    for spec in specs:
        for side in 1, -1:
            for cos in ".93", ".41", ".07":
                wo = direction(side * mpf(cos), azimuth(rng))
                yield spec, wo, reflected_at(wo, facet(rng, a, a, 0, .01))
                yield spec, wo, refracted_at(wo, facet(rng, a, a, 0, .01),
                                             mpf("1.5") ** side) or \
                    tuple(-x for x in wo)


def eval_rows():
    rng = random.Random(SEED)
    yield from diffuse_rows(rng)
    for distribution in ("beckmann", "ggx"):
        yield from microfacet_rows(rng, rough_specs(rng, distribution), 1)
    yield from microfacet_rows(rng, course_specs(rng), 2)
    yield from dark_rows(rng)
    for distribution in ("beckmann", "ggx"):
        yield from glass_lobe_rows(rng, distribution)
        yield from glass_steep_rows(rng, distribution, 2)
        yield from glass_wide_rows(rng, distribution)
        yield from glass_part_rows(rng, distribution)
    yield from nested_rows(rng)


def sample_specs():
    """Each with the n of which wo is taken to the critical angle, or None."""
    yield "mirror:reflectance=.31/.47/.83", None
    for over_cos in "true", "false":
        yield (f"course_mirror:reflectance=.31/.47/.83,over_cos={over_cos}",
               None)
    for material in MATERIALS:
        yield f"conductor:{material},specular_reflectance=.31/.47/1", None
    metal = f"conductor:{MATERIALS[0]},specular_reflectance=1/1/1"
    yield f"twosided:front=({metal}),back=(mirror:reflectance=.3/.4/.5)", None
    yield f"twosided:front=({metal})", None

    for glass in GLASS:
        n = relative_index(parsed("x:" + glass)[1], (0, 0, 1))
        yield f"refraction:{glass},specular_transmittance=.9/.62/.2", n
        for fresnel, tint in ("exact", TINTS[0]), ("schlick", TINTS[1]):
            yield f"dielectric:{glass},fresnel={fresnel},{tint},lobes=both", n
        yield f"thindielectric:{glass},{TINTS[1]}", n
    for fresnel, lobes in itertools.product(("exact", "schlick"),
                                            ("reflection", "transmission")):
        yield (f"dielectric:{GLASS[0]},fresnel={fresnel},{TINTS[1]},"
               f"lobes={lobes}", number("1.5"))
    for ior, factor in itertools.product(("1.5", "2.4"), ("course", "right")):
        yield (f"course_refraction:transmittance=.9/.62/.2,ior={ior},"
               f"factor={factor}", number(ior))
        for at in "inside", "thinner":
            yield (f"course_glass:reflectance=.31/.47/.83,"
                   f"transmittance=.9/.62/.2,ior={ior},factor={factor},"
                   f"schlick_at={at}", number(ior))


def sample_rows():
    """(spec, wo)"""
    rng = random.Random(SEED)
    for spec, n in sample_specs():
        for side in 1, -1:
            cosines = COSINES[::3]
            if n and (n < 1) == (side > 0):
                critical = mp.sqrt(1 - min(n, 1 / n) ** 2)
                cosines = cosines + [critical * (1 + sign * mpf(10) ** -e)
                                     for sign in (-1, 1) for e in (12, 9, 3)]
            for cos in cosines:
                yield spec, direction(side * cos, azimuth(rng))


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


def brief(x):
    return "0" if x == 0 else mp.nstr(x, 2, min_fixed=1, max_fixed=0)


def eval_table(out):
    out.write(f"""\
# f and pdf of the models, in twenty of fifty digits
# written by: python3 tests/golden.py OUTDIR, seed {SEED}
# formulas and their sources: the head of tests/golden.py
# made for this project; no measured data in it
# wo and wi: unit vectors rounded to double, taken as exact: cos_o = wo.z,
#   cos_i = wi.z, h along wo + wi, wi.h = |wo + wi| / 2
# slopes of h over alpha, squared: at most {MAX_SLOPE2}
# df, dpdf: relative change of f and pdf if the steps that may cancel are each
#   one rounding off; 0 where there are none
# spec\two.x\two.y\two.z\twi.x\twi.y\twi.z\tf[0] [1/sr]\tf[1]\tf[2]\tpdf [1/sr]\tdf\tdpdf
""")
    for spec, wo, wi in eval_rows():
        values = settled(evaluate, spec, wo, wi)
        out.write("\t".join([spec] + [x.hex() for x in wo + wi]
                            + [decimal(v) for v in values[:4]]
                            + [brief(v) for v in values[4:]]) + "\n")


def sample_table(out):
    out.write(f"""\
# what the models of one direction or two sample, in twenty of fifty digits
# written by: python3 tests/golden.py OUTDIR, seed {SEED}
# formulas and their sources: the head of tests/golden.py
# made for this project; no measured data in it
# wo: a unit vector rounded to double, taken as exact: cos_o = wo.z
# begin, end: this branch is drawn for u.z in [begin, end)
# wi, pdf, weight: all 0 where the light is absorbed
# dwi.z, dpdf: change of wi.z and pdf if the square of the root in them is one
#   rounding off
# spec\two.x\two.y\two.z\tbegin\tend\twi.x\twi.y\twi.z\tpdf [1]\tweight[0]\tweight[1]\tweight[2]\tdwi.z\tdpdf
""")
    for spec, wo in sample_rows():
        rows = settled(lambda: sum(sampled(spec, wo), []))
        for i in range(0, len(rows), 11):
            row = rows[i:i + 11]
            out.write("\t".join([spec] + [x.hex() for x in wo]
                                + [decimal(v) for v in row[:9]]
                                + [brief(v) for v in row[9:]]) + "\n")


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
    for name, table in (("eval.tsv", eval_table), ("sample.tsv", sample_table),
                        ("fresnel.tsv", fresnel_table)):
        with open(os.path.join(sys.argv[1], name), "w", encoding="ascii",
                  newline="\n") as out:
            table(out)


if __name__ == "__main__":
    main()
