/* pipe.h - a model that another program computes
 *
 * The program speaks protocol.h.  Threads that ask at the same time have a
 * process each.  A program that crashes, hangs, leaves or answers what cannot
 * be an answer is killed and started again: the record that did it is looked
 * for by asking in smaller and smaller portions, its values are NaN, and
 * bsdf_trouble has a sentence with the pair of directions (or the direction and
 * the random numbers).  Where that happens too often, every value is NaN from
 * then on, until the trouble is asked for or for good, see PIPE_RESTARTS.
 */
#ifndef VALIDATE_PIPE_H
#define VALIDATE_PIPE_H

#include "bsdf/bsdf.h"

enum {
    PIPE_RESTARTS = 12,        /* of an instance */
    PIPE_RESTARTS_OF_VIEW = 3, /* of a thread, between two bsdf_trouble */
};

/** For instances made from now on: how long one request may take [s], 10 unless
 * set; the handshake may take three times that. */
void pipe_set_time_limit(double seconds);

/** Starts the program (argv ends in NULL and is copied) and asks what it is.
 * The spec is what bsdf_spec gives.  NULL and the reason if it does not start,
 * or does not speak the protocol. */
struct bsdf *pipe_new(const char *spec, char *const argv[],
                      const struct bands *bands, struct err *err);

#endif
