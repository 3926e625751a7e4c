/* What is odd about bodies before the first step. Drawback: overlaps that large plates have with each other
   are not looked for to the end. */
#include "rigid/dynamics_state.h"
#include "geom/vec3.h"
#include "rigid/overlap.h"
#include <stdio.h>
#include <string.h>

/* Adds a line to the notes; lines that do not fit are left out. */
static void note(char *notes, size_t room, const char *line)
{
    size_t used = strlen(notes);
    if (used + strlen(line) + 2 < room) snprintf(notes + used, room - used, "%s\n", line);
}

/* How deep contact sees two bodies in each other, m; what it leaves alone does not count. */
static double find_overlap(tobi_dynamics_state *d, int a, int b)
{
    double deepest = 0;
    d->contacts.count = 0;
    tobi_touch_bodies(&d->bodies[a], &d->shapes[a], &d->bodies[b], &d->shapes[b],
                      (tobi_touch_look){ 0, 0 }, &d->contacts);
    for (int64_t k = 0; k < d->contacts.count; k++)
        if (-d->contacts.at[k].gap > 2*d->contacts.at[k].slop)
            deepest = fmax(deepest, -d->contacts.at[k].gap);
    return deepest;
}

/* Overlaps that contact does not see, or not as deep as they are, would last, and bodies fall through each
   other. Between balls it sees all. */
static tobi_status check_overlap(const tobi_dynamics_state *d, int a, int b, double seen, int *whole,
                                 tobi_error *err)
{
    const tobi_shape *sa = &d->shapes[a], *sb = &d->shapes[b];
    double least = TOBI_TOUCH_DEEPEST*fmin(sa->thickness, sb->thickness);
    double deep = tobi_overlap_depth(&d->bodies[a], sa, &d->bodies[b], sb, least, whole);
    if (seen >= 0.8*deep) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID,
                     "bodies '%s' and '%s' overlap by %.3g m at the start; contact can part these two from "
                     "at most %.3g m: move one of them, or make them one mesh", d->bodies[a].name,
                     d->bodies[b].name, deep, least);
}

static tobi_status note_overlaps(tobi_dynamics_state *d, char *notes, size_t room, tobi_error *err)
{
    enum { NAMED = 5 };
    int found = 0, unsure = 0;
    char line[TOBI_NOTE], whole[2*TOBI_NOTE];
    TOBI_TRY(tobi_broad_find(&d->broad, d->bodies, d->shapes, d->count, 0, err));
    for (int64_t k = 0; k < d->broad.pair_count; k++) {
        int a = d->broad.pairs[k].a, b = d->broad.pairs[k].b, searched;
        if (tobi_constraints_join(d->world.constraints, a, b)) continue;
        double deep = find_overlap(d, a, b);
        TOBI_TRY(check_overlap(d, a, b, deep, &searched, err));
        if (!searched && ++unsure <= NAMED) {
            snprintf(whole, sizeof whole, tr("'%s' lies so close to body '%s' over so large an area that not "
                     "all places were searched for overlaps at the start"), d->bodies[a].name,
                     d->bodies[b].name);
            note(notes, room, whole);
        }
        if (deep == 0 || ++found > NAMED) continue;
        snprintf(line, sizeof line,
                 tr("overlaps body '%s' by %.3g m at the start; contact pushes them apart"),
                 d->bodies[b].name, deep);
        snprintf(whole, sizeof whole, "'%s' %s", d->bodies[a].name, line);
        note(notes, room, whole);
    }
    if (found > NAMED) {
        snprintf(line, sizeof line, tr("%d more pairs of bodies overlap at the start"), found - NAMED);
        note(notes, room, line);
    }
    if (unsure > NAMED) {
        snprintf(line, sizeof line, tr("%d more pairs of bodies were not searched for overlaps to the end"),
                 unsure - NAMED);
        note(notes, room, line);
    }
    d->contacts.count = 0;
    return d->contacts.failed ? tobi_fail(err, TOBI_NO_MEMORY, "no memory for contacts") : TOBI_OK;
}

static void note_shapes(const tobi_dynamics_state *d, char *notes, size_t room)
{
    char line[TOBI_NOTE];
    for (int k = 0; k < d->count; k++) {
        const tobi_body *b = &d->bodies[k];
        const tobi_facets *f = &d->shapes[k].facets;
        if (!d->shapes[k].solid)
            snprintf(line, sizeof line, tr("'%s' deforms and is no prism along z: bodies pass through it"),
                     b->name);
        else if (f->ball > 0)
            snprintf(line, sizeof line,
                     tr("'%s' is taken for a ball of radius %.6g m in contact with bodies and sides; its "
                     "faces lie up to %.2g m below"), b->name, f->ball, f->ball_gap);
        else continue;
        note(notes, room, line);
    }
}

static void note_planes(tobi_dynamics_state *d, char *notes, size_t room)
{
    for (int k = 0; k < d->count; k++) {
        char line[TOBI_NOTE];
        double deepest = 0;
        d->contacts.count = 0;
        tobi_dynamics_touch_planes(d, k, 0, &d->contacts);
        for (int64_t i = 0; i < d->contacts.count; i++)
            if (-d->contacts.at[i].gap > 2*d->contacts.at[i].slop)
                deepest = fmax(deepest, -d->contacts.at[i].gap);
        if (deepest == 0) continue;
        snprintf(line, sizeof line,
                 tr("'%s' reaches %.3g m behind a side or plane at the start; contact pushes it back"),
                 d->bodies[k].name, deepest);
        note(notes, room, line);
    }
    d->contacts.count = 0;
}

tobi_status tobi_dynamics_note(tobi_dynamics_state *d, char *notes, size_t room, tobi_error *err)
{
    note_shapes(d, notes, room);
    TOBI_TRY(note_overlaps(d, notes, room, err));
    note_planes(d, notes, room);
    return TOBI_OK;
}
