/* fresnel.h - reflectance of a smooth interface for unpolarised light
 *
 * cos_i is the cosine of the angle of incidence, in [0, 1].  Indices are
 * relative: those of the far medium over that of the medium the light is in.
 */
#ifndef BSDF_FRESNEL_H
#define BSDF_FRESNEL_H

/** Exact, for a complex index eta + i k with eta, k >= 0, not both 0 unless
 * total reflection is meant.
 * M. Born and E. Wolf, Principles of Optics, 7th ed., 1999, sec. 14.2. */
double fresnel_conductor(double cos_i, double eta, double k);

/** The write-up's (Rs + Rp) / 2, good where eta^2 + k^2 >> 1. */
double fresnel_conductor_approx(double cos_i, double eta, double k);

/** C. Schlick, An Inexpensive BRDF Model for Physically-based Rendering, CGF
 * 13(3), 1994: r0 + (1 - r0) (1 - cos_i)^5. */
double fresnel_schlick(double cos_i, double r0);

/** Exact, for a real index eta > 0; 1 beyond the critical angle.  cos_t, if
 * not NULL, takes the cosine of the refracted direction, or 0.
 * Born and Wolf, sec. 1.5.2. */
double fresnel_dielectric(double cos_i, double eta, double *cos_t);

/** 1 less that, from both cosines, cos_t beyond: without its cancellation where
 * nearly all is reflected, and without cos_t's own near the critical angle. */
double fresnel_dielectric_through(double cos_i, double cos_t, double eta);

#endif
