/* handshake.h - what an adapter says of itself, see protocol.h */
#ifndef VALIDATE_HANDSHAKE_H
#define VALIDATE_HANDSHAKE_H

#include "bsdf/bsdf.h"

struct handshake {
    struct bsdf_claims claims;
    bool text;            /* numbers as text, not binary */
    bool single;          /* float */
    bool cosine_included; /* eval gives f |wi.z| */
    bool given_wi;        /* importance */
};

enum { HANDSHAKE_MAX = 256 };

/** Writes what the toolkit says first; returns its length, below
 * HANDSHAKE_MAX. */
size_t handshake_ask(const struct bands *bands, char text[HANDSHAKE_MAX]);

/** Whether all of an answer is there: an empty line, or a line or a number of
 * them that is too large. */
bool handshake_whole(const char *answer, size_t n);

/** Reads an answer of n bytes.  False and the reason; where the adapter gives
 * one, its own. */
bool handshake_read(struct handshake *h, const char *answer, size_t n,
                    struct err *err);

#endif
