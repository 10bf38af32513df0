/* vec.c - directions from angles and back
 *
 * The angle is reduced in degrees, where fmod and remquo are exact, so that
 * 90 degrees is exactly horizontal and a full turn changes nothing.
 */
#include "bsdf/vec.h"

static void sincos_degrees(double deg, double *s, double *c)
{
    int quarter;
    const double r = remquo(fmod(deg, 360), 90, &quarter) * (PI / 180);
    const double sr = sin(r), cr = cos(r);
    switch (quarter & 3) {
    case 0:
        *s = sr, *c = cr;
        break;
    case 1:
        *s = cr, *c = -sr;
        break;
    case 2:
        *s = -sr, *c = -cr;
        break;
    default:
        *s = -cr, *c = sr;
    }
}

struct vec3 dir_from_degrees(double theta_deg, double phi_deg)
{
    double st, ct, sp, cp;
    sincos_degrees(theta_deg, &st, &ct);
    sincos_degrees(phi_deg, &sp, &cp);
    return (struct vec3){ st * cp + 0., st * sp + 0., ct + 0. }; /* no -0 */
}

struct angles dir_to_degrees(struct vec3 w)
{
    return (struct angles){ atan2(hypot(w.x, w.y), w.z) * (180 / PI),
                            atan2(w.y, w.x) * (180 / PI) };
}
