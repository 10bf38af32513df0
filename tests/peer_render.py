"""peer_render.py - the scenes of data/scenes/ here and in Mitsuba 3

    python3 tests/peer_render.py BSDF-RENDER PYTHON FOLDER [WORD...]

renders each of CASES whose name has all the words in it with bsdf-render and,
under PYTHON, which has Mitsuba, with two of its variants; compares the pictures
by `bsdf-render --compare` and prints verdicts and times.  Metals in R, G, B are
taken the way Mitsuba does (--rgb average).  Pictures stay in FOLDER.  The exit
status is 1 if two pictures are not estimates of the same one.

Mitsuba's pictures are the mean of RUNS independent ones, whose spread gives the
variance of each pixel.
"""

import os
import re
import subprocess
import sys
import time

RUNS = 16
SAMPLES = 256
SIZE = (160, 120)
VARIANTS = ("scalar_rgb", "llvm_ad_rgb")

# Name, file, settings of the file.
CASES = (
    ("diffuse", "spheres_diffuse.xml", {"max_depth": 6}),
    ("mirror and glass", "spheres.xml", {"max_depth": 6}),
    ("rough metals", "spheres_metal.xml", {"max_depth": 6}),
    ("furnace", "furnace.xml", {}),
    # The constants of gold differ, so a perfect mirror of facets.
    ("metal mesh", "mesh.xml", {"max_depth": 6, "material": "none"}),
)


def mitsuba(variant, scene, picture, settings):
    """Renders under Mitsuba; prints the seconds that rendering took."""
    import mitsuba as mi
    import numpy as np

    mi.set_variant(variant)
    loaded = mi.load_file(scene, **settings)
    mi.render(loaded, spp=1, seed=12345)  # compiles, where there is a compiler
    start = time.time()
    runs = [
        np.array(mi.render(loaded, spp=SAMPLES // RUNS, seed=seed))[:, :, :3]
        for seed in range(RUNS)
    ]
    seconds = time.time() - start
    mean = np.mean(runs, axis=0)
    variance = np.var(runs, axis=0, ddof=1) / RUNS
    count = np.full(mean.shape[:2] + (1,), RUNS)
    pixels = np.concatenate((mean, variance, count), axis=2)
    names = ["R", "G", "B", "variance.R", "variance.G", "variance.B", "count"]
    mi.Bitmap(
        pixels.astype(np.float32),
        pixel_format=mi.Bitmap.PixelFormat.MultiChannel,
        channel_names=names,
    ).write(picture)
    print(seconds)


def ours(program, scene, picture, settings):
    """The seconds that rendering took, as bsdf-render says."""
    command = [program, scene, "-s", str(SAMPLES), "-f", picture]
    command += ["--rgb", "average"]
    for name, value in settings.items():
        command += ["-D", f"{name}={value}"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: {done.stderr}")
    return float(re.search(r"rays in ([0-9.]+) s", done.stderr).group(1))


def theirs(python, variant, scene, picture, settings):
    """The same of Mitsuba; None and why where the variant does not run."""
    command = [python, os.path.abspath(__file__), "--mitsuba", variant]
    command += [scene, picture]
    command += [f"{name}={value}" for name, value in settings.items()]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        return None, done.stderr.strip().splitlines()[-1]
    return float(done.stdout.strip().splitlines()[-1]), ""


def compare(program, a, b):
    """Whether the pictures agree, and what is said about it."""
    done = subprocess.run(
        [program, "--compare", a, b], capture_output=True, text=True
    )
    if done.returncode == 2:
        sys.exit(done.stderr)
    return done.returncode == 0, done.stdout.strip()


def main(program, python, folder, words):
    os.makedirs(folder, exist_ok=True)
    agree = True
    print(f"{SIZE[0]} x {SIZE[1]} pixels, {SAMPLES} samples a pixel")
    for name, file, settings in CASES:
        if not all(word in name for word in words):
            continue
        settings = dict(settings, width=SIZE[0], height=SIZE[1])
        scene = os.path.join("build", "scenes", file)
        stem = os.path.join(folder, file.removesuffix(".xml"))
        mine = stem + ".exr"
        print(f"{name}: bsdf-render {ours(program, scene, mine, settings):.2f} s")
        for variant in VARIANTS:
            picture = f"{stem}_{variant}.exr"
            seconds, why = theirs(python, variant, scene, picture, settings)
            if seconds is None:
                print(f"  {variant}: does not run here: {why}")
                continue
            same, said = compare(program, mine, picture)
            agree &= same
            print(f"  {variant} {seconds:.2f} s, {'same' if same else 'DIFFERS'}")
            print("    " + said.replace("\n", "\n    "))
    return 0 if agree else 1


if __name__ == "__main__":
    if sys.argv[1] == "--mitsuba":
        mitsuba(
            sys.argv[2],
            sys.argv[3],
            sys.argv[4],
            dict(pair.split("=", 1) for pair in sys.argv[5:]),
        )
    else:
        sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]))
