/* key.c - laying out a key in rows */
#include "plots/key.h"

const char key_wo[] =
    "head filled size screen 0.011,20 lc rgb \"#000000\" dt 1 lw 1.5";
const char key_mirror[] = "nohead lc rgb \"#a8a8a8\" dt 1 lw 6";
const char key_delta[] =
    "head filled size screen 0.014,18 lc rgb \"#000000\" dt 1 lw 2.5";

/* In pixels. */
enum { SAMPLE = 30, GAP = 7, APART = 24, MARGIN = 12 };

double key_text_width(const char *text)
{
    const double letter = 7.2;
    size_t letters = 0;
    for (; *text; text++)
        letters += ((unsigned char)*text & 0xc0) != 0x80;
    return letter * (double)letters;
}

static double entry_width(const struct key_entry *e)
{
    return SAMPLE + GAP + key_text_width(e->text);
}

/* How many entries fit into the next row, and what they take. */
static int row_fill(const struct key_entry *entry, int n, double page,
                    double *width)
{
    int i = 0;
    *width = 0;
    while (i < n) {
        const double more = (i ? APART : 0) + entry_width(&entry[i]);
        if (i > 0 && *width + more > page - 2 * MARGIN)
            break;
        *width += more;
        i++;
    }
    return i;
}

int key_rows(const struct key_entry *entry, int n, double width)
{
    int rows = 0;
    double used;
    for (int at = 0; at < n; rows++)
        at += row_fill(entry + at, n - at, width, &used);
    return rows;
}

static void sample(struct figure *fig, const struct key_entry *e, double x,
                   double y)
{
    const double w = fig->width, h = fig->height;
    if (e->look[0])
        fprintf(fig->script,
                "set arrow from screen %.6g,%.6g to screen %.6g,%.6g %s\n",
                x / w, y / h, (x + SAMPLE) / w, y / h, e->look);
    if (e->point[0])
        fprintf(fig->script, "set label \"\" at screen %.6g,%.6g point %s\n",
                (x + SAMPLE / 2.) / w, y / h, e->point);
}

void key_draw(struct figure *fig, const struct key_entry *entry, int n,
              double y)
{
    for (int at = 0; at < n; y -= KEY_ROW) {
        double width;
        const int end = at + row_fill(entry + at, n - at, fig->width, &width);
        double x = (fig->width - width) / 2;
        for (; at < end; at++) {
            sample(fig, &entry[at], x, y);
            figure_label(fig, x + SAMPLE + GAP, y, "left", entry[at].text);
            x += entry_width(&entry[at]) + APART;
        }
    }
}
