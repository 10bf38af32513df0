/* disk.h - the unit square onto the unit disk, area for area
 *
 * P. Shirley and K. Chiu, A Low Distortion Map Between Disk and Square, Journal
 * of Graphics Tools 2(3), 1997, without its cases but two.
 */
#ifndef INTEGRATOR_DISK_H
#define INTEGRATOR_DISK_H

#include "bsdf/vec.h"

struct disk_point {
    double x, y;
};

static inline struct disk_point disk_map(double u, double v)
{
    const double a = 2 * u - 1, b = 2 * v - 1;
    if (a == 0 && b == 0)
        return (struct disk_point){ 0, 0 };
    const double r = fabs(a) > fabs(b) ? a : b;
    const double phi =
        fabs(a) > fabs(b) ? PI / 4 * (b / a) : PI / 2 - PI / 4 * (a / b);
    return (struct disk_point){ r * cos(phi), r * sin(phi) };
}

#endif
