/* key.h - the line of a page that says what lines and arrows mean
 *
 * gnuplot's own key is no wider than a panel.
 */
#ifndef PLOTS_KEY_H
#define PLOTS_KEY_H

#include "plots/figure.h"

enum { KEY_ROW = 20 }; /* pixels from one row to the next */

struct key_entry {
    char look[96];  /* of an arrow; "" for none */
    char point[64]; /* of a label with a point; "" for none */
    char text[128];
};

/* What some arrows look like, in plots and in keys. */
extern const char key_wo[], key_mirror[], key_delta[];

/** About what a text in the usual letters takes [pixels]. */
double key_text_width(const char *text);

/** How many rows there will be on a page so wide. */
int key_rows(const struct key_entry *entry, int n, double width);

/** Draws the entries in rows; y is the middle of the top one. */
void key_draw(struct figure *fig, const struct key_entry *entry, int n,
              double y);

#endif
