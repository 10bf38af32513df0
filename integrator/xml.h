/* xml.h - XML files, opened with bounds, and places in them
 *
 * No document type definition, and so no entity, is taken; nothing but the file
 * itself is read.  Nodes are libxml2's.
 */
#ifndef INTEGRATOR_XML_H
#define INTEGRATOR_XML_H

#include <libxml/tree.h>
#include <stdbool.h>
#include <stddef.h>

#include "bsdf/err.h"

/** Elements nest this deep at the most. */
enum { XML_DEPTH_MAX = 100 };

struct xml {
    xmlDoc *doc;
    const char *path; /* borrowed; what messages say */
    size_t bytes;     /* of the text */
};

/** Reads a whole file, which may be packed by xz; then its text is at most 32
 * times as long as the file, and 64 KiB. False and the reason, with the line,
 * if it is no well-formed XML. */
bool xml_open(struct xml *x, const char *path, struct err *err);
void xml_close(struct xml *x);

/** Reads a whole file of at most 2^31 - 1 bytes, with a 0 behind; NULL and the
 * reason.  Owned by the caller. */
char *xml_read_file(const char *path, size_t *size, struct err *err);

/** Always false; "FILE:LINE: <element id>: what". */
__attribute__((format(printf, 3, 4))) bool
xml_fail(const xmlNode *node, struct err *err, const char *format, ...);

/** An attribute's text as it is in the document, borrowed; NULL if there is
 * none. */
const char *xml_get(const xmlNode *node, const char *attribute);

bool xml_is(const xmlNode *node, const char *name);

/** The first element below, and the next beside; NULL where there is none. */
xmlNode *xml_first(const xmlNode *node);
xmlNode *xml_next(const xmlNode *node);

/** The first element below of this name; NULL where there is none. */
xmlNode *xml_child(const xmlNode *node, const char *name);

/** Numbers in a text, separated by white space, or commas where allowed. */
struct xml_numbers {
    const xmlNode *node;
    const char *text;
    bool commas;
    size_t count; /* that were read */
};

/** Of an element's text; it may have nothing else inside. */
bool xml_numbers(const xmlNode *node, struct xml_numbers *n, struct err *err);

/** Whether there is none left. */
bool xml_numbers_end(struct xml_numbers *n);

/** The next; false and the reason if it is none, or not finite. */
bool xml_real(struct xml_numbers *n, double *value, struct err *err);
bool xml_count(struct xml_numbers *n, unsigned *value, struct err *err);

/** So many of them and no more. */
bool xml_reals(struct xml_numbers *n, double *value, size_t count,
               struct err *err);

/** By id; a node's id is its own in the whole document.  Owned by the caller,
 * freed by xmlHashFree(ids, NULL). */
struct _xmlHashTable *xml_ids(const struct xml *x, struct err *err);

#endif
