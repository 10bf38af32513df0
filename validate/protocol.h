/* protocol.h - how a model in another program is asked
 *
 * The toolkit starts `sh -c COMMAND` (an adapter), writes to its standard input
 * and reads its standard output; standard error is the adapter's own.  Both
 * speak first in lines, then in blocks of numbers.  adapters/README.md tells
 * the same to those who write an adapter, in any language.
 *
 * The handshake is text, each line ends in \n.  The toolkit sends
 *
 *     bsdf 1
 *     bands 3 614 549 466       how many, and vacuum wavelengths [nm], or
 *                               `bands 3 R G B` for linear sRGB
 *     (an empty line)
 *
 * and the adapter answers with lines `key value`, in any order but the first,
 * and an empty line:
 *
 *     bsdf 1                    first; there is one version
 *     format binary|text        binary: host byte order, IEEE doubles
 *     name WORDS
 *     lobes WORD...             required, any of diffuse_reflection,
 *                               glossy_reflection, delta_reflection,
 *                               diffuse_transmission, glossy_transmission and
 *                               delta_transmission
 *     lossless yes|no           no: the albedo is 1
 *     reciprocal yes|no         yes: light may go back the way it came
 *     two_sided yes|no          no: it answers a wo below the surface
 *     eta X                     1: index below the surface over that above
 *     precision double|float    double: what it computes in
 *     cosine excluded|included  excluded: eval gives f; included: f |wi.z|
 *     given wo|wi               wo: radiance; wi: importance, see below
 *     parameter KEY VALUE ...   for people; any number
 *     error TEXT                instead: it could not be made, and why
 *
 * where the first word behind a key is the default, if there is one.  At most
 * PROTOCOL_LINES lines of PROTOCOL_LINE bytes.
 *
 * Then the toolkit asks, n records at a time, n from 1 to PROTOCOL_RECORDS:
 *
 *     op       record             answer, bands is their count
 *     eval     wo.xyz, wi.xyz     f [1/sr], one a band
 *     pdf      wo.xyz, wi.xyz     the density of wi [1/sr]
 *     sample   wo.xyz, u.xyz      wi.xyz, pdf, weight one a band, delta: 5 +
 *                                 bands numbers; all 0 where refused
 *
 * u is uniform in [0, 1)^3, and all that chance there is: the same u gives the
 * same sample.  weight = f |wi.z| / pdf, whatever `cosine` says.  delta is 1
 * where the direction has a probability (pdf [1]) in place of a density, else
 * 0.  Frame and directions are those of bsdf/bsdf.h.
 *
 * Binary: a struct protocol_header and n records of PROTOCOL_NUMBERS doubles;
 * the answer is the same header and n answers.  Text: a line `eval n`, `pdf n`
 * or `sample n`, and n lines of PROTOCOL_NUMBERS numbers as %.17g; the answer
 * is n lines of numbers between blanks, in any form that strtod reads, of
 * PROTOCOL_TEXT_LINE bytes at most, and n at most PROTOCOL_TEXT_RECORDS.  At
 * the end the toolkit closes the adapter's input, and it leaves.
 *
 * `given wi`: the direction that is given is the light's, the one asked about
 * or sampled the viewer's, as for a path that starts at a light; f and weight
 * of transmission are not scaled by the indices then.  The toolkit takes the
 * given direction for wo, and multiplies f and weights of pairs on different
 * sides by (n_o / n_i)^2, n_o the index on the side of the given direction and
 * n_i that of the other (1 above, eta below): for a reciprocal model that is f
 * of radiance, as f*(wo, wi) = f(wi, wo) = f(wo, wi) n_i^2 / n_o^2.
 */
#ifndef VALIDATE_PROTOCOL_H
#define VALIDATE_PROTOCOL_H

#include <stdint.h>

enum {
    PROTOCOL_VERSION = 1,
    PROTOCOL_RECORDS = 65536,
    PROTOCOL_NUMBERS = 6,
    PROTOCOL_LINES = 256,
    PROTOCOL_LINE = 4096, /* bytes, the newline among them */
    PROTOCOL_TEXT_RECORDS = 1024,
    PROTOCOL_TEXT_LINE = 512,
};

enum protocol_op { PROTOCOL_EVAL = 1, PROTOCOL_PDF, PROTOCOL_SAMPLE };

struct protocol_header {
    uint32_t op, n;
};

/** The numbers of one answer. */
static inline int protocol_answer(enum protocol_op op, int bands)
{
    return op == PROTOCOL_EVAL ? bands : op == PROTOCOL_PDF ? 1 : 5 + bands;
}

#endif
