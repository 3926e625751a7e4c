/* The tracks of bodies, from the table bodies.csv of a run. Drawback: the whole table is read. */
#define _GNU_SOURCE 1
#include "base/error.h"
#include "base/plain.h"
#include "tobiuo/results.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

tobi_status tobi_track_add(tobi_moment *m, const char *body, const double point[3], tobi_error *err)
{
    int k = 0;
    TOBI_NEED(m, "the moment");
    TOBI_NEED(body, "the body");
    TOBI_NEED(point, "the point");
    while (k < m->track_count && strncmp(m->tracks[k].body, body, sizeof m->tracks[k].body - 1) != 0) k++;
    if (k == m->track_count) {
        tobi_moment_track *tracks = reallocarray(m->tracks, (size_t)k + 1, sizeof *tracks);
        if (!tracks) return tobi_fail(err, TOBI_NO_MEMORY, "tracks: out of memory");
        m->tracks = tracks;
        tracks[m->track_count++] = (tobi_moment_track){ 0 };
        snprintf(tracks[k].body, sizeof tracks[k].body, "%s", body);
    }
    tobi_moment_track *t = &m->tracks[k];
    if (t->count == t->room) {
        const int64_t room = 2*t->room + 64;
        double (*points)[3] = reallocarray(t->points, (size_t)room, sizeof *points);
        if (!points) return tobi_fail(err, TOBI_NO_MEMORY, "tracks: out of memory");
        t->points = points, t->room = room;
    }
    for (int a = 0; a < 3; a++) t->points[t->count][a] = (float)point[a];      /* as precise as the table */
    t->count++;
    return TOBI_OK;
}

/* Reads a text of a row, quoted or not; returns what follows its comma, or NULL at the end. */
static const char *read_cell(const char *at, char *out, size_t room)
{
    const int quoted = *at == '"';
    size_t n = 0;
    for (at += quoted; *at && *at != '\n' && (quoted || *at != ','); at++) {
        if (quoted && *at == '"' && *++at != '"') break;
        if (n + 1 < room) out[n++] = *at;
    }
    out[n] = '\0';
    return *at == ',' ? at + 1 : NULL;
}

/* Its columns begin with time, name and the three of the position. */
static tobi_status read_row(const char *row, tobi_moment *m, tobi_error *err)
{
    char cell[96], name[64];
    double value[4];
    const char *at = read_cell(row, cell, sizeof cell);
    char *end;
    value[3] = strtod(cell, &end);
    if (end == cell || !at || !(value[3] <= m->time*(1 + 1e-12))) return TOBI_OK;
    at = read_cell(at, name, sizeof name);
    for (int a = 0; a < 3; a++) {
        if (!at) return TOBI_OK;
        at = read_cell(at, cell, sizeof cell);
        value[a] = strtod(cell, NULL);
    }
    return tobi_track_add(m, name, value, err);
}

tobi_status tobi_tracks_read(const char *dir, tobi_moment *m, tobi_error *err)
{
    char *path = NULL, *text;
    size_t size;
    TOBI_NEED(dir, "the folder");
    TOBI_NEED(m, "the moment");
    if (asprintf(&path, "%s/bodies.csv", dir) < 0)
        return tobi_fail(err, TOBI_NO_MEMORY, "tracks: out of memory");
    tobi_status status = tobi_plain_read(path, tr("table of bodies"), 0, &text, &size, err);
    free(path);
    if (status == TOBI_NOT_FOUND) return TOBI_OK;
    TOBI_TRY(status);
    const char *row = strchr(text, '\n');
    while (status == TOBI_OK && row && row[1]) {
        status = read_row(row + 1, m, err);
        row = strchr(row + 1, '\n');
    }
    free(text);
    return status;
}
