/* compat.h - the course's ways of doing things, by name
 *
 * What a course's path tracer does otherwise than the physics, so that pictures
 * made by it can be made again; none of it is on unless asked for.
 */
#ifndef INTEGRATOR_COMPAT_H
#define INTEGRATOR_COMPAT_H

#include "bsdf/err.h"

enum compat {
    COMPAT_CAMERA = 1,       /* the view is that of 800 x 600, cropped */
    COMPAT_TONE = 2,         /* (sqrt(2) L)^(1/2.2), truncated to 8 bits */
    COMPAT_LIGHT_PDF = 4,    /* an area light falls off by d, not d^2 */
    COMPAT_LIGHT_QUAD = 8,   /* the <area> light is sampled, the mesh seen */
    COMPAT_SCHLICK = 16,     /* Schlick with the inner angle on the way out */
    COMPAT_LAMBDA = 32,      /* pi for sqrt(pi) in Beckmann's Lambda */
    COMPAT_FRESNEL = 64,     /* a metal's Fresnel term at n.wi, approximate */
    COMPAT_REFRACTION = 128, /* radiance times ior^2 for ior^-2 */
    COMPAT_COURSE = 255      /* all of them */
};

/** Reads "course", "none", or some of "camera,tone,light-pdf,light-quad,
 * schlick,lambda,fresnel,refraction". */
bool compat_parse(unsigned *compat, const char *text, struct err *err);

/** Writes the parts' names, separated by commas; "none" for 0. */
void compat_print(unsigned compat, char *text, int size);

#endif
