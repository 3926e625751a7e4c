/* Names of files for bodies and lines: their own, of any script, with blanks and signs as "_", and a number
   if taken. Drawback: a body that is renamed has other files. */
#include "record/record.h"
#include "world/world.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* The names given so far. */
typedef struct names { tobi_record_name *body, *traction, *line; int bodies, lines; } names;

static bool is_taken(const names *n, const char *name)
{
    static const char *const ours[] = { "all", "fluid", "bodies", "grid", "surface", "foam" };
    for (size_t k = 0; k < sizeof ours/sizeof *ours; k++)
        if (strcmp(ours[k], name) == 0) return true;
    for (int k = 0; k < n->bodies; k++)
        if (strcmp(n->body[k], name) == 0 || strcmp(n->traction[k], name) == 0) return true;
    for (int k = 0; k < n->lines; k++)
        if (strcmp(n->line[k], name) == 0) return true;
    return false;
}

/* A name and that of its tractions. */
static bool is_free(const names *n, const char *name)
{
    char tractions[96];
    snprintf(tractions, sizeof tractions, "%.80s_tractions", name);
    return !is_taken(n, name) && !is_taken(n, tractions);
}

static bool stays(char c)
{
    const unsigned char code = (unsigned char)c;
    return code >= 0x80 || isalnum(code) || strchr("-_", c);
}

static void make_name(const names *n, const char *own, const char *otherwise, tobi_record_name out)
{
    char stem[72] = "", name[88];
    for (size_t k = 0; own[k] && k + 1 < sizeof stem; k++)
        stem[k] = stays(own[k]) ? own[k] : '_';
    if (!*stem) snprintf(stem, sizeof stem, "%s", otherwise);
    snprintf(name, sizeof name, "%s", stem);
    for (int i = 2; !is_free(n, name); i++) snprintf(name, sizeof name, "%s_%d", stem, i);
    snprintf(out, sizeof(tobi_record_name), "%s", name);
}

tobi_status tobi_record_name_bodies(const tobi_world *w, tobi_record_name **body, tobi_record_name **traction,
                                    tobi_record_name **line, tobi_error *err)
{
    const int bodies = tobi_world_body_count(w), lines = tobi_world_line_count(w);
    names n = { .body = calloc((size_t)bodies + 1, sizeof **body),
                .traction = calloc((size_t)bodies + 1, sizeof **traction),
                .line = calloc((size_t)lines + 1, sizeof **line) };
    *body = n.body, *traction = n.traction, *line = n.line;
    if (!n.body || !n.traction || !n.line) return tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    for (int k = 0; k < bodies; k++) {
        make_name(&n, tobi_world_body_name(w, k), "body", n.body[k]);
        snprintf(n.traction[k], sizeof n.traction[k], "%.80s_tractions", n.body[k]);
        n.bodies++;
    }
    for (int k = 0; k < lines; k++) {
        char own[96];
        snprintf(own, sizeof own, "line_%.80s", w->lines[k].name);
        make_name(&n, own, "line", n.line[k]);
        n.lines++;
    }
    return TOBI_OK;
}
