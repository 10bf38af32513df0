"""peer_mitsuba.py - the BSDFs of Mitsuba 3, validated, and why those fail that do

    python3 tests/peer_mitsuba.py BSDF-VALIDATE PYTHON [WORD...]

runs bsdf-validate on each of models() whose name has all the words in it,
through validate/adapters/mitsuba_bsdf.py under PYTHON, which has Mitsuba, and
prints what failed, where, by how much and why.  Verdicts, values and limits are
those of the run.  CAUSES only explains them, each only where its own arithmetic
says that it is large enough: a failure that none explains is said to be
unexplained, and makes the exit status 1.
"""

import json
import math
import os
import re
import subprocess
import sys
import tempfile
import time

ADAPTER = "validate/adapters/mitsuba_bsdf.py"
SAMPLES = 100000
ABOVE, BELOW = ("30,40", "75,40"), ("150,40",)


WHITE = {"type": "rgb", "value": [1, 1, 1]}


def models():
    """A BSDF, whether it transmits, and the variant if not the default one."""
    yield (
        {
            "type": "diffuse",
            "reflectance": {"type": "rgb", "value": [0.2, 0.5, 0.9]},
        },
        False,
        None,
    )
    yield {"type": "conductor", "material": "Au"}, False, None
    for alpha in (0.001, 0.01, 0.05, 0.1, 0.5, 1.0):
        for distribution in ("beckmann", "ggx"):
            for visible in (True, False):
                yield (
                    {
                        "type": "roughconductor",
                        "material": "Au",
                        "alpha": alpha,
                        "distribution": distribution,
                        "sample_visible": visible,
                    },
                    False,
                    None,
                )
    yield (
        {
            "type": "roughconductor",
            "material": "Au",
            "alpha_u": 0.3,
            "alpha_v": 0.1,
            "distribution": "ggx",
        },
        False,
        None,
    )
    yield {"type": "dielectric"}, True, None
    yield {"type": "thindielectric"}, True, None
    for alpha in (0.01, 0.1, 0.5):
        for distribution in ("beckmann", "ggx"):
            yield (
                {
                    "type": "roughdielectric",
                    "alpha": alpha,
                    "distribution": distribution,
                },
                True,
                None,
            )
    yield (
        {"type": "roughdielectric", "alpha": 0.1, "distribution": "ggx"},
        True,
        "scalar_rgb",
    )
    yield {"type": "plastic"}, False, None
    yield {"type": "plastic", "nonlinear": True}, False, None
    for alpha in (0.05, 0.3):
        for distribution in ("beckmann", "ggx"):
            yield (
                {
                    "type": "roughplastic",
                    "alpha": alpha,
                    "distribution": distribution,
                },
                False,
                None,
            )
    yield (
        {"type": "roughplastic", "alpha": 0.3, "distribution": "ggx"},
        False,
        "scalar_rgb",
    )
    yield {"type": "principled"}, False, None
    yield {"type": "principled", "base_color": WHITE}, False, None
    yield (
        {"type": "principled", "roughness": 0.3, "metallic": 1.0},
        False,
        None,
    )
    yield (
        {
            "type": "principled",
            "roughness": 0.3,
            "metallic": 0.5,
            "anisotropic": 0.6,
            "spec_tint": 0.5,
        },
        False,
        None,
    )
    yield {"type": "principled", "sheen": 1.0, "flatness": 0.5}, False, None
    yield (
        {"type": "principled", "clearcoat": 1.0, "clearcoat_gloss": 0.5},
        False,
        None,
    )
    yield (
        {
            "type": "principled",
            "base_color": WHITE,
            "sheen": 1.0,
            "clearcoat": 1.0,
        },
        False,
        None,
    )
    yield (
        {"type": "principled", "roughness": 0.4, "spec_trans": 1.0},
        True,
        None,
    )
    yield (
        {
            "type": "principled",
            "roughness": 0.4,
            "spec_trans": 0.5,
            "metallic": 0.2,
        },
        True,
        None,
    )
    yield (
        {
            "type": "principledthin",
            "eta": 1.4,
            "spec_trans": 0.5,
            "diff_trans": 0.8,
        },
        True,
        None,
    )


# -- causes -------------------------------------------------------------------
# Each takes a BSDF, its variant and a failed verdict, and says whether it is
# what explains it.


def xyz(w):
    return w["xyz"]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def facet(a, b, weight):
    """The unit normal along a + weight b, z not negative."""
    m = [x + weight * y for x, y in zip(a, b)]
    length = math.copysign(math.sqrt(dot(m, m)), m[2])
    return [x / length for x in m]


def rational_masking(bsdf, variant, verdict):
    """Beckmann's G1 is off by more than 1e-4 toward the given direction, and
    what failed is not off by more than twice that."""
    if (
        bsdf["type"] not in ("roughconductor", "roughdielectric")
        or bsdf["distribution"] != "beckmann"
    ):
        return False
    if not bsdf.get("sample_visible", True) or verdict["check"] not in (
        "pdf",
        "chi2",
        "jacobian",
        "weights",
    ):
        return False
    x, y, z = xyz(verdict["wo"])
    a = abs(z) / (bsdf["alpha"] * math.hypot(x, y))
    exact = 2 / (1 + math.erf(a) + math.exp(-a * a) / (a * math.sqrt(math.pi)))
    fit = (
        1
        if a >= 1.6
        else (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a)
    )
    off = abs(fit / exact - 1)
    said = (
        re.search(r"(?:sum|share =) ([0-9.]+)", verdict["note"])
        if verdict["check"] in ("pdf", "jacobian")
        else None
    )
    return off > 1e-4 and (
        said is None or abs(float(said.group(1)) - 1) < 2 * off
    )


def lost_sine(bsdf, variant, verdict):
    """A facet's sine is known to no more than 1e-4, from 1 - cos^2 in float."""
    if bsdf["type"] != "roughconductor" or bsdf["sample_visible"]:
        return False
    if verdict["check"] not in ("sample", "chi2", "jacobian"):
        return False
    sine2 = bsdf["alpha"] ** 2
    if verdict.get("wi"):
        m = facet(xyz(verdict["wo"]), xyz(verdict["wi"]), 1)
        sine2 = m[0] ** 2 + m[1] ** 2
    return 2.0**-24 > 1e-4 * sine2


def grazed_facet(bsdf, variant, verdict):
    """Light leaves a facet that it grazes: cos_t, from 1 - eta^2 sin^2 in float,
    is known to no more than 1e-4."""
    eta = {"roughdielectric": 1.5046 / 1.000277, "principled": 1.5}.get(
        bsdf["type"]
    )
    if not eta or verdict["check"] != "reciprocity" or not verdict.get("wi"):
        return False
    o, i = xyz(verdict["wo"]), xyz(verdict["wi"])
    if o[2] * i[2] >= 0:
        return False
    above, below = (o, i) if o[2] > 0 else (i, o)
    cosine = dot(below, facet(above, below, eta))
    rest = 1 - eta**2 * (1 - cosine**2)
    return abs(rest) < eta**2 * 2.0**-24 / 1e-4


def unmasked_pdf(bsdf, variant, verdict):
    """pdf() answers where the model is 0, below the surface and at the horizon,
    in the vectorised variants."""
    if bsdf["type"] not in ("roughplastic", "principledthin") or variant:
        return False
    note, check = verdict["note"], verdict["check"]
    if check == "finite":
        return (
            bool(re.search(r"first: pdf = -?nan", note))
            and abs(xyz(verdict["wo"])[2]) < 1e-7
        )
    if bsdf["type"] == "principledthin":
        return False
    return (
        check == "support"
        and note.startswith("pdf =")
        and "other side" in note
        or check == "pdf"
        and "integral 1.0" in note
        or check == "chi2"
    )


def corner(bsdf, variant, verdict):
    """The visible normals of GGX at u = (0, 1/2), where the disk's rim is."""
    return (
        bsdf.get("distribution") == "ggx"
        and bsdf.get("sample_visible", True)
        and verdict["check"] in ("finite", "sample")
        and "nan" in verdict["note"]
        and ("u = (0, 0.5)" in verdict["note"] or verdict["check"] == "sample")
    )


def thin_sides(bsdf, variant, verdict):
    return (
        bsdf["type"] == "principledthin"
        and bsdf.get("spec_trans", 0) > 0
        and verdict["check"] == "reciprocity"
        and xyz(verdict["wo"])[2] * xyz(verdict["wi"])[2] < 0
    )


def by_design(bsdf, variant, verdict):
    return (
        bsdf["type"] == "principled"
        and bsdf.get("base_color") == WHITE
        and verdict["check"] == "energy"
    )


CAUSES = {
    rational_masking: "the masking of Beckmann facets is a rational fit",
    lost_sine: "float: the sine of a facet that is drawn from all normals",
    grazed_facet: "float: the cosine beyond a facet that light grazes",
    unmasked_pdf: "pdf() is not masked in the vectorised variants",
    corner: "NaN on the rim of the disk of GGX's visible normals",
    thin_sides: "a facet's side is judged by the wrong direction",
    by_design: "the principled model is not made to conserve energy",
}
WHY = {
    rational_masking: (
        """\
    smith_g1() of microfacet.h takes Walter's fit, good to 0.35 %, while visible
    normals are drawn exactly: pdf and weight are off by as much, and by the same
    everywhere.  At alpha 0.5 from 75 degrees the fit is 0.29 % below
    2 / (1 + erf(a) + exp(-a^2) / (a sqrt(pi))).  GGX, whose masking is exact,
    has no such failure.  Theirs, and known to them: a comment there says so."""
    ),
    lost_sine: (
        """\
    sample() of microfacet.h, sample_visible off, has sin = sqrt(1 - cos^2): in
    float that leaves 2^-24 / sin^2 of it.  At alpha 0.001 Beckmann draws 37
    different angles in 20000; at 0.01 1877, at 0.1 nearly as many as there are.
    Theirs, of single precision alone; sqrt(tan^2 / (1 + tan^2)) would not have it,
    nor do visible normals, the default."""
    ),
    grazed_facet: (
        """\
    Fresnel's cos_t is the root of 1 - eta^2 (1 - cos^2), which is near 0 for a facet
    that the light beyond grazes; f is proportional to it.  From the other side it
    is known well, so the two ways differ.  The same formulas in double agree to 1e-9
    at five such pairs with GGX; in numpy's float they are 0.1 to 5 % apart.  At the
    two worst, with Beckmann, cos_t^2 is 6e-8 and 3e-8, one rounding of 1.
    Single precision; the values are a small part of the peak's."""
    ),
    unmasked_pdf: (
        """\
    pdf() and eval_pdf() of roughplastic.cpp put cos > 0 into `active`, return early
    where no lane is active, and then `return result` without it, so that only the
    scalar variants give 0 below the surface (the scalar run below is sound).  The
    integral over the sphere exceeds 1, and at the horizon there is 0 / 0.
    principledthin.cpp returns its pdf likewise.  Theirs; harmless to who looks at
    the value first, as it is 0 there."""
    ),
    corner: (
        """\
    sample_visible_11() of microfacet.h maps u = (0, 1/2) to the disk's rim, y = z = 0:
    rcp(sin y + cos z) is infinite and infinity times 0 is no number.  roughdielectric
    passes it on in the scalar variant.  Theirs, at one point of the square."""
    ),
    thin_sides: (
        """\
    principledthin.cpp finds the half vector from the mirrored direction, but
    mac_mic_compatibility() and the masking G are given the one that goes through, so
    that pairs drop out one way that count the other way.  The comment there says
    that the model is symmetric.  Theirs."""
    ),
    by_design: (
        """\
    B. Burley, Physically Based Shading at Disney, 2012: diffuse, sheen and clearcoat
    are added to the specular lobe without taking from one another."""
    ),
}


# -- running ------------------------------------------------------------------


def name_of(bsdf):
    def value(x):
        return (
            "/".join(f"{v:g}" for v in x["value"])
            if isinstance(x, dict)
            else (
                str(x).lower()
                if isinstance(x, bool)
                else x if isinstance(x, str) else f"{x:g}"
            )
        )

    settings = ",".join(
        f"{k}={value(v)}" for k, v in bsdf.items() if k != "type"
    )
    return bsdf["type"] + (":" + settings if settings else "")


def cause_of(bsdf, variant, verdict):
    return next((c for c in CAUSES if c(bsdf, variant, verdict)), None)


def run(validate, python, bsdf, transmits, variant):
    """The verdicts, or what went wrong in words."""
    chosen = f"--variant {variant} " if variant else ""
    spec = f"pipe:{python} {ADAPTER} {chosen}'{json.dumps(bsdf)}'"
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "run.json")
        command = [validate, spec, "--samples", str(SAMPLES), "--json", out]
        for wo in ABOVE + (BELOW if transmits else ()):
            command += ["--wo", wo]
        done = subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        if done.returncode not in (0, 1):
            return None, done.stderr.strip()
        with open(out) as f:
            results = json.load(f)["results"]
    verdicts = [
        v
        for r in results
        for v in r["verdicts"]
        if v["verdict"] != "not applicable"
    ]
    for v in verdicts:
        if v["wi"] and v["wi"]["theta_deg"] is None:
            v["wi"] = None  # no direction at all
    return verdicts, None


def worst_first(verdict):
    ratio = (
        verdict["value"] / verdict["limit"]
        if verdict["limit"] and verdict["value"] is not None
        else float("inf")
    )
    return -ratio


def angles(w):
    return f"{w['theta_deg']:.6g},{w['phi_deg']:.5g}"


def number(x):
    return "nan" if x is None else f"{x:.6g}"


def main(argv):
    if len(argv) < 2:
        sys.exit(__doc__)
    validate, python, words = argv[0], argv[1], argv[2:]
    sound = failing = unexplained = broken = 0
    reasons = {}
    begin = time.monotonic()
    for bsdf, transmits, variant in models():
        name = name_of(bsdf) + (f" ({variant})" if variant else "")
        if not all(w in name for w in words):
            continue
        start = time.monotonic()
        verdicts, trouble = run(validate, python, bsdf, transmits, variant)
        seconds = time.monotonic() - start
        if verdicts is None:
            print(
                f"{name}  {seconds:.0f} s: could not be run: {trouble}",
                flush=True,
            )
            broken += 1
            continue
        failed = {}
        for v in verdicts:
            if v["verdict"] == "fail":
                failed.setdefault(v["check"], []).append(v)
        print(
            f"{name}  {seconds:.0f} s: {len(verdicts)} verdicts, "
            f"{'sound' if not failed else 'FAIL ' + ' '.join(failed)}",
            flush=True,
        )
        sound, failing = sound + (not failed), failing + bool(failed)
        for check, of_check in failed.items():
            # Every direction must be explained; the worst that is not is shown.
            of_check.sort(
                key=lambda v: (
                    cause_of(bsdf, variant, v) is not None,
                    worst_first(v),
                )
            )
            v = of_check[0]
            cause = cause_of(bsdf, variant, v)
            wi = f", wi = {angles(v['wi'])}" if v.get("wi") else ""
            print(
                f"    {check} {number(v['value'])}, limit"
                f" {number(v['limit'])}{' ' + v['unit'] if v['unit'] else ''},"
                f" at wo = {angles(v['wo'])}{wi}\n      {v['note']}\n     "
                f" {CAUSES[cause] if cause else 'UNEXPLAINED'}",
                flush=True,
            )
            unexplained += cause is None
            if cause:
                reasons[cause] = reasons.get(cause, 0) + 1
    print(
        f"\n{sound} models sound, {failing} with failing checks, {broken} not"
        f" run, {unexplained} failures unexplained,"
        f" {time.monotonic() - begin:.0f} s"
    )
    for cause in CAUSES:
        if cause in reasons:
            print(f"\n{CAUSES[cause]}: {reasons[cause]}\n{WHY[cause]}")
    return 1 if unexplained or broken else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
