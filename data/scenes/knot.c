/* knot.c - writes knot.ply, the mesh of mesh.xml
 *
 * A tube around a trefoil knot, with smooth bumps: curved in every way, closed,
 * in its own shadow, and without a crossing.  It lies in y with the lowest
 * point at 0, within .65 of the axis; 500 rings of 70 quadrilaterals, that is
 * 35,000 vertices and 70,000 triangles.  Normals are those of the surface, by
 * differences of its own formula.
 *
 * usage: knot FILE
 */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/vec.h"

enum { RINGS = 500, SIDES = 70 };
enum { VERTICES = RINGS * SIDES, TRIANGLES = 2 * VERTICES };

/* The knot winds 3 times around a torus' tube while it goes round twice. */
static const double ring = .37, coil = .165, tube = .1, bump = .014;

/* Where the knot is on the torus: its point, and the torus' normal there. */
static struct vec3 knot(double t, struct vec3 *normal)
{
    const double a = 2 * t, b = 3 * t;
    const struct vec3 n = { cos(a) * cos(b), sin(b), sin(a) * cos(b) };
    *normal = n;
    return (struct vec3){ (ring * cos(a)) + coil * n.x, coil * n.y,
                          (ring * sin(a)) + coil * n.z };
}

/* The surface at u, v in turns. */
static struct vec3 surface(double u, double v)
{
    const double t = 2 * PI * u, angle = 2 * PI * v, step = 1e-5;
    struct vec3 n, unused;
    const struct vec3 p = knot(t, &n);
    const struct vec3 along =
        vec3_unit(vec3_minus(knot(t + step, &unused), knot(t - step, &unused)));
    /* The torus' normal is at right angles to what runs on it. */
    const struct vec3 side = vec3_cross(n, along);
    const double r = tube + bump * cos(24 * t) * cos(5 * angle + 6 * t);
    return vec3_add(p, vec3_add(vec3_scale(r * cos(angle), n),
                                vec3_scale(r * sin(angle), side)));
}

static struct vec3 normal(double u, double v)
{
    const double step = 1e-5;
    const struct vec3 du =
        vec3_minus(surface(u + step, v), surface(u - step, v));
    const struct vec3 dv =
        vec3_minus(surface(u, v + step), surface(u, v - step));
    return vec3_unit(vec3_cross(du, dv));
}

static bool put_float(FILE *f, double value)
{
    const float rounded = (float)value;
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    for (int i = 0; i < 4; i++)
        putc((int)(bits >> 8 * i & 255), f);
    return !ferror(f);
}

static void put_triangle(FILE *f, unsigned a, unsigned b, unsigned c)
{
    const unsigned corner[] = { a, b, c };
    putc(3, f);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 4; i++)
            putc((int)(corner[k] >> 8 * i & 255), f);
}

static void write_ply(FILE *f, const struct vec3 *p, const struct vec3 *n,
                      double low)
{
    fprintf(f,
            "ply\nformat binary_little_endian 1.0\n"
            "comment a trefoil knot with bumps, no unit of length\n"
            "comment made by data/scenes/knot.c, GPL-3.0-or-later\n"
            "element vertex %d\n"
            "property float x\nproperty float y\nproperty float z\n"
            "property float nx\nproperty float ny\nproperty float nz\n"
            "element face %d\nproperty list uchar int vertex_indices\n"
            "end_header\n",
            VERTICES, TRIANGLES);
    for (int i = 0; i < VERTICES; i++) {
        const double row[] = { p[i].x, p[i].y - low, p[i].z,
                               n[i].x, n[i].y,       n[i].z };
        for (int k = 0; k < 6; k++)
            put_float(f, row[k]);
    }
    for (unsigned i = 0; i < RINGS; i++)
        for (unsigned k = 0; k < SIDES; k++) {
            const unsigned next = (i + 1) % RINGS, beside = (k + 1) % SIDES;
            const unsigned a = i * SIDES + k, b = next * SIDES + k;
            const unsigned c = next * SIDES + beside, d = i * SIDES + beside;
            put_triangle(f, a, b, c);
            put_triangle(f, a, c, d);
        }
}

int main(int argc, char **argv)
{
    static struct vec3 p[VERTICES], n[VERTICES];
    double low = INFINITY;
    FILE *f = argc == 2 ? fopen(argv[1], "wb") : NULL;
    if (!f) {
        perror(argc == 2 ? argv[1] : "usage: knot FILE");
        return 2;
    }
    for (int i = 0; i < VERTICES; i++) {
        const double u = (double)(i / SIDES) / RINGS;
        const double v = (double)(i % SIDES) / SIDES;
        p[i] = surface(u, v);
        n[i] = normal(u, v);
        low = fmin(low, p[i].y);
    }
    write_ply(f, p, n, low);
    const bool bad = ferror(f);
    if (fclose(f) != 0 || bad) {
        perror(argv[1]);
        return 2;
    }
    return 0;
}
