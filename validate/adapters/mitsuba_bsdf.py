#!/usr/bin/env python3
#
# MIT No Attribution
#
# Permission is hereby granted, free of charge, to any person obtaining a copy
# of this software and associated documentation files (the "Software"), to deal
# in the Software without restriction, including without limitation the rights
# to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
# copies of the Software, and to permit persons to whom the Software is
# furnished to do so.
#
# THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
# IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
# FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
# AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
# LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
# OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
# SOFTWARE.
"""mitsuba_bsdf.py - any BSDF of Mitsuba 3, as an adapter of bsdf-validate

    bsdf-validate 'pipe:python mitsuba_bsdf.py BSDF'

BSDF is a dictionary in JSON, as mitsuba.load_dict takes it; XML that starts
with <bsdf or <scene; or the name of an .xml file.  What the two programs say
to one another is in validate/protocol.h; MITSUBA.md has examples.

Names.  The toolkit gives wo and asks about wi.  In Mitsuba si.wi is given and
wo asked about, so the two change places here.  In both, f of radiance is meant
(TransportMode.Radiance).  Mitsuba's eval has the cosine, and so has ours.

Random numbers.  u.z chooses (sample1), u.x and u.y place (sample2).  They are
rounded to the variant's precision and kept below 1, as by Mitsuba's samplers.

Refused samples.  Mitsuba returns weight 0, with a pdf and a direction that mean
nothing: a reflection that fell below the surface may lie where light is
transmitted.  So what has weight 0 is refused, unless that is right: in a delta
lobe, or on the side of the lobe it is said to be of, with a positive pdf() and
an eval() of 0, as of a black surface.
"""

import argparse
import json
import os
import runpy
import struct
import sys

EVAL, PDF, SAMPLE = 1, 2, 3
RECORDS_MAX = 65536
NUMBERS = 6  # a record

# Older ones cannot compile fmaximum for x86-64 and end the process.
LLVM_MIN = 17

# A row of numbers begins at a multiple of so many bytes: Dr.Jit compiles one
# kernel for rows that do and another for those that do not.
ALIGNMENT = 64

LOBES = {  # ours, and the flags of Mitsuba's that are one
    "diffuse_reflection": ("DiffuseReflection",),
    "glossy_reflection": ("GlossyReflection",),
    "delta_reflection": ("DeltaReflection",),
    "diffuse_transmission": ("DiffuseTransmission",),
    "glossy_transmission": ("GlossyTransmission",),
    "delta_transmission": ("DeltaTransmission", "Null"),
}
CLAIMS = ("lossless", "reciprocal", "two_sided", "eta")

# With nothing that scales their lobes, these lose no light.
LOSSLESS = ("SmoothDielectric", "ThinDielectric", "Null")


class Refused(Exception):
    """Why there is no such BSDF; goes to the toolkit."""


def claim(text):
    key, _, value = text.partition("=")
    if key not in CLAIMS or not value:
        raise argparse.ArgumentTypeError(
            f"\"{text}\": expected KEY=VALUE with a key of {', '.join(CLAIMS)}"
        )
    return key, value


def place(text):
    try:
        u, v = (float(x) for x in text.split(","))
    except ValueError:
        raise Refused(
            f"--uv {text}: expected two numbers, as in 0.5,0.5"
        ) from None
    return u, v


def arguments(argv):
    parser = argparse.ArgumentParser(
        description="Any BSDF of Mitsuba 3, as an adapter of bsdf-validate."
    )
    parser.add_argument(
        "bsdf",
        metavar="BSDF",
        help="a dictionary in JSON, XML, or the name of an .xml file",
    )
    parser.add_argument(
        "--variant",
        metavar="NAME",
        help=(
            "of Mitsuba; if not given llvm_ad_rgb, or llvm_ad_spectral where "
            f"wavelengths are asked for, or without LLVM {LLVM_MIN} scalar_..."
        ),
    )
    parser.add_argument("--id", metavar="ID", help="which BSDF of a scene")
    parser.add_argument(
        "--uv",
        metavar="U,V",
        default="0.5,0.5",
        help="where textures are looked up; 0.5,0.5",
    )
    parser.add_argument(
        "--import",
        metavar="FILE.py",
        dest="script",
        action="append",
        default=[],
        help=(
            "run this first, as to register BSDFs written in Python; may be"
            " repeated"
        ),
    )
    parser.add_argument(
        "--claim",
        metavar="KEY=VALUE",
        action="append",
        default=[],
        type=claim,
        help="say this of the BSDF instead of what was found out: "
        + ", ".join(CLAIMS),
    )
    parser.add_argument(
        "--threads",
        metavar="N",
        type=int,
        default=1,
        help="of the LLVM variants; 1",
    )
    return parser.parse_args(argv)


# -- Mitsuba ------------------------------------------------------------------


def variant_for(given, wavelengths):
    """The variant to use, and set."""
    import drjit as dr
    import mitsuba as mi

    colour = "spectral" if wavelengths else "rgb"
    llvm = dr.detail.llvm_version()[0] >= LLVM_MIN
    name = given or ("llvm_ad_" if llvm else "scalar_") + colour
    if name not in mi.variants():
        raise Refused(
            f"variant \"{name}\": expected one of {', '.join(mi.variants())}"
        )
    if "polarized" in name:
        raise Refused(f'variant "{name}": polarization is not asked about')
    if "mono" not in name and colour not in name:
        raise Refused(
            f'variant "{name}": expected one of {colour}, as the toolkit '
            f"asks for {'wavelengths' if wavelengths else 'R, G, B'}"
        )
    if name.startswith("llvm") and not llvm:
        raise Refused(
            f'variant "{name}": expected LLVM {LLVM_MIN} or later, as in'
            f" Debian's libllvm19, found {dr.detail.llvm_version()[0]}"
            " (DRJIT_LIBLLVM_PATH names one)"
        )
    mi.set_variant(name)
    return name


def bsdf_of_scene(scene, wanted):
    found = {}
    for shape in scene.shapes():
        found.setdefault(shape.bsdf().id(), shape.bsdf())
    if wanted in found:
        return found[wanted]
    if wanted is None and len(found) == 1:
        return next(iter(found.values()))
    raise Refused(
        f"--id {wanted or 'is missing'}: expected one of the scene's,"
        f" {', '.join(found)}"
    )


def load(args):
    import mitsuba as mi

    text = args.bsdf.strip()
    for script in args.script:
        runpy.run_path(script)
    try:
        if text.startswith("{"):
            loaded = mi.load_dict(json.loads(text))
        elif text.startswith("<"):
            loaded = mi.load_string(text)
        else:
            loaded = mi.load_file(text)
    except Exception as e:
        raise Refused(f"{text[:200]}: {e}") from e
    if isinstance(loaded, list) and len(loaded) == 1:
        loaded = loaded[0]
    if isinstance(loaded, mi.Scene):
        loaded = bsdf_of_scene(loaded, args.id)
    if not isinstance(loaded, mi.BSDF):
        raise Refused(
            f"{text[:200]}: expected a BSDF, got {type(loaded).__name__}"
        )
    return loaded


class Model:
    """A BSDF at one point of a surface that is z = 0 there."""

    def __init__(self, bsdf, variant, wavelengths, uv):
        import drjit as dr
        import mitsuba as mi

        self.bsdf = bsdf
        self.context = mi.BSDFContext()  # radiance, all components
        self.wavelengths = wavelengths
        self.uv = uv
        self.scalar = variant.startswith("scalar")
        self.double = "double" in variant
        # The largest number below 1 that a sampler gives.
        self.below_one = 1 - (2.0**-53 if self.double else 2.0**-24)
        self.ops = self.eval, self.pdf, self.sample
        self.point = None
        if self.scalar:
            self.point = self.surface()
        else:
            self.freeze()

    def freeze(self):
        """Traces each operation once; what cannot be is traced every time."""
        import drjit as dr
        import numpy as np

        record = np.array([[0.6, 0, 0.8, 0, 0.6, 0.8]], dtype=np.float32)
        plain, frozen = self.ops, []
        for op, f in zip((EVAL, PDF, SAMPLE), plain):
            self.ops = [dr.freeze(f, state_fn=lambda *_: self.bsdf)] * 3
            try:
                self.all(op, record)
                frozen.append(self.ops[0])
            except RuntimeError:
                frozen.append(f)
        self.ops = frozen

    def interaction(self, given):
        si = self.point or self.surface()
        si.wi = given
        return si

    def surface(self):
        import drjit as dr
        import mitsuba as mi

        si = dr.zeros(mi.SurfaceInteraction3f)
        si.t = 1
        si.n = mi.Normal3f(0, 0, 1)
        si.sh_frame = mi.Frame3f(
            mi.Vector3f(1, 0, 0), mi.Vector3f(0, 1, 0), mi.Vector3f(0, 0, 1)
        )
        si.dp_du, si.dp_dv = mi.Vector3f(1, 0, 0), mi.Vector3f(0, 1, 0)
        si.uv = mi.Point2f(*self.uv)
        if self.wavelengths:
            padded = (self.wavelengths + 4 * self.wavelengths[-1:])[:4]
            si.wavelengths = type(si.wavelengths)(*padded)
        return si

    def eval(self, given, asked):
        return self.bsdf.eval(self.context, self.interaction(given), asked)

    def pdf(self, given, asked):
        return self.bsdf.pdf(self.context, self.interaction(given), asked)

    def sample(self, given, u):
        """Direction, pdf, weight, whether delta, and whether there is one."""
        import drjit as dr
        import mitsuba as mi

        si = self.interaction(given)
        bs, weight = self.bsdf.sample(
            self.context, si, u.z, mi.Point2f(u.x, u.y)
        )
        delta = mi.has_flag(bs.sampled_type, mi.BSDFFlags.Delta)
        # Most are; what follows takes most of the time of a scalar variant.
        if self.scalar and any(w != 0 for w in weight):
            return bs.wo, bs.pdf, weight, delta, True
        there = dr.any(weight != 0)
        same = bs.wo.z * si.wi.z
        reflected = mi.has_flag(bs.sampled_type, mi.BSDFFlags.Reflection)
        transmitted = mi.has_flag(bs.sampled_type, mi.BSDFFlags.Transmission)
        side = (reflected & (same > 0)) | (transmitted & (same < 0))
        value, density = self.eval(given, bs.wo), self.pdf(given, bs.wo)
        black = dr.select(
            delta, bs.pdf > 0, side & dr.all(value == 0) & (density > 0)
        )
        return bs.wo, bs.pdf, weight, delta, there | black

    def answer(self, op, record, bands):
        """The numbers that go back for an array of records."""
        import numpy as np

        n = len(record)
        record = record.astype(np.float64 if self.double else np.float32)
        if op == SAMPLE:
            record[:, 3:] = np.minimum(record[:, 3:], self.below_one)
        rows = self.each(op, record) if self.scalar else self.all(op, record)
        if op == PDF:
            return np.reshape(rows, (n, 1))
        if op == EVAL:
            return widened(rows, bands)
        wi, pdf, weight, delta, there = rows
        out = np.concatenate(
            [wi, pdf[:, None], widened(weight, bands), delta[:, None]], axis=1
        )
        out[~there.astype(bool)] = 0
        return out

    def all(self, op, record):
        import mitsuba as mi
        import numpy as np

        # Filled up with the first record, which is as good as any.
        rows = aligned(NUMBERS, len(record), record.dtype)
        rows[:, : len(record)] = record.T
        rows[:, len(record) :] = record[:1].T
        answer = self.ops[op - 1](mi.Vector3f(rows[:3]), mi.Vector3f(rows[3:]))
        size = rows.shape[1], len(record)
        if op != SAMPLE:
            return column(answer, *size)
        return [column(x, *size) for x in answer]

    def each(self, op, record):
        import mitsuba as mi
        import numpy as np

        f, vector = self.ops[op - 1], mi.Vector3f
        answers = [
            f(vector(a, b, c), vector(x, y, z))
            for a, b, c, x, y, z in record.tolist()
        ]
        if op == PDF:
            return np.array(answers)
        if op == EVAL:
            return np.array([list(f) for f in answers])
        rows = np.array(
            [
                (*wi, pdf, *weight, delta, there)
                for wi, pdf, weight, delta, there in answers
            ]
        )
        return rows[:, :3], rows[:, 3], rows[:, 4:-2], rows[:, -2], rows[:, -1]


def column(values, asked, n):
    """The first n of Dr.Jit's values.  A constant may come once, or as often as
    was asked for when the operation was traced."""
    import numpy as np

    rows = values.numpy().T
    return rows[:n] if len(rows) == asked else np.repeat(rows[:1], n, axis=0)


def aligned(rows, length, dtype):
    """An array of at least that length, a multiple of ALIGNMENT bytes."""
    import numpy as np

    width = -(-length * dtype.itemsize // ALIGNMENT) * ALIGNMENT
    memory = np.empty(rows * width + ALIGNMENT, dtype=np.uint8)
    begin = -memory.ctypes.data % ALIGNMENT
    return memory[begin : begin + rows * width].view(dtype).reshape(rows, -1)


def widened(values, bands):
    """A column for each band: the first of a spectrum's four, or one for all."""
    import numpy as np

    values = values.reshape(len(values), -1)
    if values.shape[1] == 1:
        return np.repeat(values, bands, axis=1)
    return values[:, :bands]


# -- what it says of itself ---------------------------------------------------


def has_any(flags, names):
    import mitsuba as mi

    return any(mi.has_flag(flags, getattr(mi.BSDFFlags, n)) for n in names)


def eta_of(model):
    """The index below over that above: the one of samples that go through."""
    import drjit as dr
    import mitsuba as mi
    import numpy as np


    def through(given, u):
        bs, weight = model.bsdf.sample(
            model.context, model.interaction(given), u.z, mi.Point2f(u.x, u.y)
        )
        return bs.eta, (bs.wo.z < 0) & dr.any(weight > 0)

    u = (
        np.arange(1024)[:, None] * [0.7548776662, 0.5698402910, 0.8191725134]
        + 0.5
    ) % 1
    given = mi.Vector3f(0.6, 0, 0.8)
    if model.scalar:
        answers = [through(given, mi.Vector3f(*x)) for x in u.tolist()]
    else:
        eta, is_through = through(
            given, mi.Vector3f(np.ascontiguousarray(u.T))
        )
        answers = np.broadcast(eta.numpy(), is_through.numpy())
    found = {float(eta) for eta, is_through in answers if is_through}
    if len(found) > 1:
        sys.stderr.write(
            f"mitsuba_bsdf.py: samples have several indices, {sorted(found)}; "
            "--claim eta=X names the one to check with\n"
        )
    return max(found, default=1)


def parameters(bsdf):
    import mitsuba as mi

    try:
        return {key: str(value) for key, value in mi.traverse(bsdf)}
    except Exception:  # some have values that Mitsuba cannot show
        return {}


def handshake(model, variant, args):
    import mitsuba as mi

    flags = model.bsdf.flags()
    lobes = [name for name, theirs in LOBES.items() if has_any(flags, theirs)]
    if not lobes:
        raise Refused("its lobes are none that the toolkit knows")
    shown = parameters(model.bsdf)
    through = has_any(
        flags,
        LOBES["diffuse_transmission"]
        + LOBES["glossy_transmission"]
        + LOBES["delta_transmission"],
    )
    scaled = any("specular_" in key for key in shown)
    yes = {True: "yes", False: "no"}
    claims = {
        "lossless": yes[model.bsdf.class_name() in LOSSLESS and not scaled],
        # Of what transmits the flag only says that radiance is compressed.
        "reciprocal": yes[through or not has_any(flags, ("NonSymmetric",))],
        "two_sided": yes[has_any(flags, ("BackSide",))],
        "eta": repr(eta_of(model) if through else 1),
    }
    claims.update(args.claim)
    lines = [
        "bsdf 1",
        "format binary",
        (
            f"name {model.bsdf.class_name()} of Mitsuba {mi.__version__},"
            f" {variant}"
        ),
        "lobes " + " ".join(lobes),
        *(f"{key} {value}" for key, value in claims.items()),
        f"precision {'double' if model.double else 'float'}",
        "cosine included",
        "given wo",
    ]
    for key, value in list(shown.items())[:100]:
        lines.append(f"parameter {key} {' '.join(value.split())[:200]}")
    return lines


# -- the pipe -----------------------------------------------------------------


def tell(out, lines):
    out.write("".join(line + "\n" for line in lines).encode() + b"\n")
    out.flush()


def bands_asked(stream):
    """Their count, and the wavelengths [nm] if they are not R, G, B."""
    lines = []
    while line := stream.readline(4096).decode(errors="replace").strip():
        lines.append(line.split())
    if (
        lines[:1] != [["bsdf", "1"]]
        or len(lines) < 2
        or lines[1][0] != "bands"
    ):
        raise Refused('expected "bsdf 1" and "bands ..." to begin with')
    names = lines[1][2:]
    if lines[1][1] != str(len(names)) or not 1 <= len(names) <= 4:
        raise Refused(f"{' '.join(lines[1])}: expected one to four bands")
    if all(name in "RGB" for name in names):
        return len(names), []
    return len(names), [float(name) for name in names]


def serve(stream, out, model, bands):
    import numpy as np

    while header := stream.read(8):
        if len(header) < 8:
            raise EOFError("half a header")
        op, n = struct.unpack("=II", header)
        if op not in (EVAL, PDF, SAMPLE) or not 1 <= n <= RECORDS_MAX:
            raise ValueError(
                f"op {op}, n {n}: expected op 1 to 3, n 1 to {RECORDS_MAX}"
            )
        block = stream.read(n * NUMBERS * 8)
        if len(block) < n * NUMBERS * 8:
            raise EOFError("half a request")
        record = np.frombuffer(block, dtype=np.float64).reshape(n, NUMBERS)
        numbers = model.answer(op, record, bands)
        out.write(
            header + np.ascontiguousarray(numbers, dtype=np.float64).tobytes()
        )
        out.flush()


def main(argv):
    # What Mitsuba prints must not get between the numbers.
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    stream = sys.stdin.buffer
    args = arguments(argv)
    try:
        bands, wavelengths = bands_asked(stream)
        uv = place(args.uv)
        try:
            import drjit as dr
            import mitsuba as mi
        except ImportError as e:
            raise Refused(f"{e} (pip install mitsuba)") from e
        dr.set_thread_count(args.threads)
        variant = variant_for(args.variant, wavelengths)
        mi.set_log_level(mi.LogLevel.Error)
        model = Model(load(args), variant, wavelengths, uv)
        lines = handshake(model, variant, args)
    except (Refused, ValueError) as e:
        tell(out, ["bsdf 1", "error " + " ".join(str(e).split())[:1000]])
        return 1
    tell(out, lines)
    try:
        serve(stream, out, model, bands)
    except BrokenPipeError:
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
