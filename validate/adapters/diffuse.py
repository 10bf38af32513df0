#!/usr/bin/env python3
"""diffuse.py - a matt surface that speaks the protocol's binary form

SPDX-License-Identifier: MIT-0, so that an adapter can start from it.

    bsdf-validate 'pipe:python3 diffuse.py 0.8'

A real one asks its renderer in place of `evaluate`, `density` and `draw`, and
may well do so with all records at once.
"""
import array
import math
import struct
import sys

EVAL, PDF, SAMPLE = 1, 2, 3


def evaluate(wo, wi, bands):
    return [reflectance / math.pi if wo[2] > 0 and wi[2] > 0 else 0.0] * bands


def density(wo, wi):
    return [wi[2] / math.pi if wo[2] > 0 and wi[2] > 0 else 0.0]


def draw(wo, u, bands):
    """wi, pdf, weight of each band, and whether it is a delta lobe's."""
    if not wo[2] > 0:
        return [0.0] * (5 + bands)
    r, phi, z = math.sqrt(u[0]), 2 * math.pi * u[1], math.sqrt(1 - u[0])
    wi = [r * math.cos(phi), r * math.sin(phi), z]
    return wi + [z / math.pi] + [reflectance] * bands + [0.0]


def handshake(stdin, stdout):
    """How many bands there are."""
    stdin.readline()  # bsdf 1
    bands = int(stdin.readline().split()[1])
    stdin.readline()
    stdout.write(b"bsdf 1\nname matt, from Python\nlobes diffuse_reflection\n\n")
    stdout.flush()
    return bands


def main():
    stdin, stdout = sys.stdin.buffer, sys.stdout.buffer
    sys.stdout = sys.stderr  # what is printed must not go to the toolkit
    bands = handshake(stdin, stdout)
    while len(header := stdin.read(8)) == 8:
        op, n = struct.unpack("=II", header)
        x = array.array("d", stdin.read(48 * n))
        answer = array.array("d")
        for at in range(0, 6 * n, 6):
            a, b = x[at:at + 3], x[at + 3:at + 6]
            answer.extend(evaluate(a, b, bands) if op == EVAL else
                          density(a, b) if op == PDF else draw(a, b, bands))
        stdout.write(header + answer.tobytes())
        stdout.flush()


reflectance = float(sys.argv[1]) if len(sys.argv) > 1 else 0.5
main()
