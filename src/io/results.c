/* The outputs of a run, by the list all.pvd. The list is read anew at each refresh, which costs its bytes
   only. Drawback: an output is read whole, fields that nobody asks for too. */
#define _GNU_SOURCE 1
#include "io/vtk_read.h"
#include "base/plain.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One file of one output. */
typedef struct entry { double time; char *name, *file; } entry;

struct tobi_results {
    char *dir;
    entry *entries;                 /* in the order of the list     */
    size_t entry_count;
    size_t *first;                  /* of each output, its entry    */
    int64_t outputs;
};

static void free_list(tobi_results *r)
{
    for (size_t k = 0; k < r->entry_count; k++) {
        free(r->entries[k].name);
        free(r->entries[k].file);
    }
    free(r->entries);
    free(r->first);
    r->entries = NULL;
    r->first = NULL;
    r->entry_count = 0;
    r->outputs = 0;
}

void tobi_results_free(tobi_results *results)
{
    if (!results) return;
    free_list(results);
    free(results->dir);
    free(results);
}

/* The value of an attribute, entities resolved, in a line of the list; owned by the caller, or NULL. */
static char *copy_attribute(const char *line, size_t length, const char *name)
{
    static const char *const entities[] = { "&amp;", "&lt;", "&gt;", "&quot;", "&apos;" };
    static const char letters[] = "&<>\"'";
    char key[32], *copy = NULL, *to;
    snprintf(key, sizeof key, " %s=\"", name);
    const char *at = memmem(line, length, key, strlen(key)), *end = line + length;
    if (!at || !(to = copy = malloc(length + 1))) return NULL;
    for (at += strlen(key); at < end && *at != '"'; at++) {
        *to = *at;
        for (size_t k = 0; *at == '&' && k < sizeof entities/sizeof *entities; k++)
            if (strncmp(at, entities[k], strlen(entities[k])) == 0) {
                *to = letters[k];
                at += strlen(entities[k]) - 1;
            }
        to++;
    }
    *to = '\0';
    return copy;
}

static tobi_status add_entry(tobi_results *r, const char *line, size_t length, tobi_error *err)
{
    entry *entries = reallocarray(r->entries, r->entry_count + 1, sizeof *entries);
    size_t *first = reallocarray(r->first, r->entry_count + 1, sizeof *first);
    if (entries) r->entries = entries;
    if (first) r->first = first;
    if (!entries || !first) return tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", r->dir);
    char *time = copy_attribute(line, length, "timestep");
    entry *e = &r->entries[r->entry_count];
    *e = (entry){ time ? strtod(time, NULL) : 0, copy_attribute(line, length, "name"),
                  copy_attribute(line, length, "file") };
    free(time);
    r->entry_count++;
    if (!time || !e->name || !e->file)
        return tobi_fail(err, TOBI_DAMAGED, "results %s/all.pvd: has an entry without time, name or file",
                         r->dir);
    if (strcmp(e->name, "fluid") == 0) r->first[r->outputs++] = r->entry_count - 1;
    return TOBI_OK;
}

static tobi_status read_list(tobi_results *r, tobi_error *err)
{
    char *path = NULL, *text;
    size_t size;
    if (asprintf(&path, "%s/all.pvd", r->dir) < 0)
        return tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", r->dir);
    tobi_status status = tobi_plain_read(path, tr("results"), 0, &text, &size, err);
    free(path);
    TOBI_TRY(status);
    for (const char *at = text; status == TOBI_OK && (at = strstr(at, "<DataSet "));) {
        const size_t length = strcspn(at, "\n");
        status = add_entry(r, at, length, err);
        at += length;
    }
    free(text);
    if (status == TOBI_OK && r->outputs == 0)
        status = tobi_fail(err, TOBI_DAMAGED, "results %s/all.pvd: lists no particles", r->dir);
    return status;
}

tobi_status tobi_results_open(const char *dir, tobi_results **results, tobi_error *err)
{
    TOBI_NEED(dir, "the folder");
    TOBI_NEED(results, "the place for the results");
    tobi_results *r = *results = calloc(1, sizeof *r);
    if (r) r->dir = strdup(dir);
    if (!r || !r->dir) {
        tobi_results_free(r);
        *results = NULL;
        return tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", dir);
    }
    tobi_status status = read_list(r, err);
    if (status == TOBI_OK) return status;
    tobi_results_free(r);
    *results = NULL;
    return status;
}

tobi_status tobi_results_refresh(tobi_results *results, tobi_error *err)
{
    TOBI_NEED(results, "the results");
    tobi_results fresh = { .dir = results->dir };
    tobi_status status = read_list(&fresh, err);
    if (status != TOBI_OK) {
        free_list(&fresh);
        return status;
    }
    free_list(results);
    *results = fresh;
    return TOBI_OK;
}

int64_t tobi_results_count(const tobi_results *results) { return results ? results->outputs : 0; }

double tobi_results_time(const tobi_results *results, int64_t output)
{
    return results && output >= 0 && output < results->outputs
            ? results->entries[results->first[output]].time : 0;
}

void tobi_moment_free(tobi_moment *m)
{
    if (!m) return;
    for (int k = 0; k < m->field_count; k++) {
        free(m->fields[k].name);
        free(m->fields[k].values);
    }
    for (int k = 0; k < m->surface_count; k++) {
        free(m->surfaces[k].name);
        free(m->surfaces[k].vertices);
        free(m->surfaces[k].triangles);
    }
    for (int k = 0; k < m->track_count; k++) free(m->tracks[k].points);
    free(m->positions);
    free(m->fields);
    free(m->surfaces);
    free(m->tracks);
    free(m->foam);
    free(m->foam_kind);
    free(m->nest);
    *m = (tobi_moment){ 0 };
}

/* A surface of a body that is there; one that is not is no failure. */
static tobi_status read_surface(const entry *e, const char *path, tobi_moment *m, tobi_error *err)
{
    tobi_moment_surface *surfaces = reallocarray(m->surfaces, (size_t)m->surface_count + 1, sizeof *surfaces);
    if (!surfaces) return tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", path);
    m->surfaces = surfaces;
    tobi_moment_surface *s = &surfaces[m->surface_count];
    *s = (tobi_moment_surface){ .name = strdup(e->name) };
    m->surface_count++;
    if (!s->name) return tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", path);
    const tobi_status status = tobi_vtp_read(path, s, err);
    if (status != TOBI_NOT_FOUND) return status;
    free(s->name);
    m->surface_count--;
    return TOBI_OK;
}

static tobi_status read_entry(const tobi_results *r, const entry *e, tobi_moment *m, tobi_error *err)
{
    char *path = NULL;
    const int fluid = strcmp(e->name, "fluid") == 0;
    if (!fluid && strncmp(e->file, "surfaces/", 9) != 0) return TOBI_OK;     /* bodies' particles, grid */
    if (asprintf(&path, "%s/%s", r->dir, e->file) < 0)
        return tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", r->dir);
    const tobi_status status = fluid ? tobi_vtu_read(path, m, err) : read_surface(e, path, m, err);
    free(path);
    return status;
}

tobi_status tobi_results_read(const tobi_results *results, int64_t output, tobi_moment *moment,
                              tobi_error *err)
{
    TOBI_NEED(results, "the results");
    TOBI_NEED(moment, "the moment");
    *moment = (tobi_moment){ 0 };
    if (output < 0 || output >= results->outputs)
        return tobi_fail(err, TOBI_INVALID, "results %s: there is no output %lld; they are 0 to %lld",
                         results->dir,
                         (long long)output, (long long)results->outputs - 1);
    const size_t begin = results->first[output];
    const size_t end = output + 1 < results->outputs ? results->first[output + 1] : results->entry_count;
    tobi_status status = TOBI_OK;
    moment->time = results->entries[begin].time;
    for (size_t k = begin; status == TOBI_OK && k < end; k++)
        status = read_entry(results, &results->entries[k], moment, err);
    if (status != TOBI_OK) tobi_moment_free(moment);
    return status;
}

/* Places and kinds of diffuse particles that stand in an output of their own. */
static tobi_status take_foam(const char *path, tobi_moment *from, tobi_moment *m, tobi_error *err)
{
    const tobi_moment_field *kind = NULL;
    for (int k = 0; k < from->field_count; k++)
        if (strcmp(from->fields[k].name, "kind") == 0) kind = &from->fields[k];
    if (!kind || kind->components != 1)
        return tobi_fail(err, TOBI_DAMAGED, "results %s: is no file of foam", path);
    m->foam_kind = malloc((size_t)from->count + 1);
    if (!m->foam_kind) return tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", path);
    for (int64_t i = 0; i < from->count; i++) m->foam_kind[i] = (uint8_t)kind->values[i];
    m->foam = from->positions;
    m->foam_count = from->count;
    from->positions = NULL;
    return TOBI_OK;
}

tobi_status tobi_results_read_foam(const tobi_results *results, int64_t output, tobi_moment *m,
                                   tobi_error *err)
{
    TOBI_NEED(results, "the results");
    TOBI_NEED(m, "the moment");
    char *path = NULL;
    tobi_moment own = { 0 };
    free(m->foam);
    free(m->foam_kind);
    m->foam = NULL, m->foam_kind = NULL, m->foam_count = 0;
    if (asprintf(&path, "%s/foam/foam_%06lld.vtp", results->dir, (long long)output) < 0)
        return tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", results->dir);
    tobi_status status = tobi_vtu_read(path, &own, err);
    if (status == TOBI_OK) status = take_foam(path, &own, m, err);
    else if (status == TOBI_NOT_FOUND) status = TOBI_OK;
    tobi_moment_free(&own);
    free(path);
    return status;
}

tobi_status tobi_results_read_bodies(const tobi_results *results, int64_t output, double (**positions)[3],
                                     int64_t *count, tobi_error *err)
{
    TOBI_NEED(results, "the results");
    TOBI_NEED(positions, "the place for the positions");
    TOBI_NEED(count, "the place for their number");
    char *path = NULL;
    tobi_moment own = { 0 };
    *positions = NULL, *count = 0;
    if (asprintf(&path, "%s/bodies/bodies_%06lld.vtu", results->dir, (long long)output) < 0)
        return tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", results->dir);
    tobi_status status = tobi_vtu_read(path, &own, err);
    if (status == TOBI_OK) *positions = own.positions, *count = own.count, own.positions = NULL;
    else if (status == TOBI_NOT_FOUND) status = TOBI_OK;
    tobi_moment_free(&own);
    free(path);
    return status;
}
