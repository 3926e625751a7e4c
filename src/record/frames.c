/* The pictures of an output. Fields that colours need are read from the world as files have them, then
   tobi_drawing_make draws what `tobiuo picture` draws of the files. Drawback: per particle some numbers are
   kept until the picture is drawn. */
#include "tobiuo/drawing.h"
#include "base/param.h"
#include "record/record.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A view and what it names; key: of the scene, for messages. */
static tobi_status add_view(tobi_run *run, const tobi_view_def *def, const char *key, tobi_error *err)
{
    tobi_record_view *view = &run->view[run->view_count++];
    char name[64];
    *view = (tobi_record_view){ .def = *def, .follow = -1 };
    snprintf(view->name, sizeof view->name, "%s", def->name ? def->name : "frame");
    snprintf(name, sizeof name, "%s.picture.field", key);
    const char *whole = tobi_world_find_field(def->field, NULL, NULL), *field = whole ? whole : def->field;
    if (field) TOBI_TRY(tobi_record_find_field(run, name, field, strlen(field), &view->field, err));
    if (!def->follow) return TOBI_OK;
    view->follow = tobi_world_find_body(run->world, def->follow);
    return view->follow >= 0 ? TOBI_OK
        : tobi_fail(err, TOBI_INVALID, "%s.picture.follow: there is no body '%s'", key, def->follow);
}

tobi_status tobi_frames_prepare(tobi_run *run, tobi_error *err)
{
    const tobi_output_def *o = &run->output;
    if (o->view_count < 0 || o->view_count > TOBI_VIEW_LIMIT || (o->view_count > 0 && !o->views))
        return tobi_fail(err, TOBI_INVALID, "output.views: has %d entries, allowed are 0 to %d",
                         o->view_count, TOBI_VIEW_LIMIT);
    run->view_count = 0;
    TOBI_TRY(add_view(run, &o->view, "output", err));
    for (int k = 0; k < o->view_count; k++) {
        const tobi_view_def *def = &o->views[k];
        char key[32];
        snprintf(key, sizeof key, "output.views[%d]", k);
        TOBI_TRY(tobi_param_check(&tobi_view_table, def, err));
        if (strlen(def->name) >= sizeof run->view->name || strchr(def->name, '/'))
            return tobi_fail(err, TOBI_INVALID, "%s.name: is no name of files", key);
        for (int n = 0; n < run->view_count; n++)
            if (strcmp(run->view[n].name, def->name) == 0)
                return tobi_fail(err, TOBI_INVALID, "%s.name: '%s' is taken", key, def->name);
        TOBI_TRY(add_view(run, def, key, err));
    }
    return TOBI_OK;
}

/* A field of the moment, from the world. */
static tobi_status add_field(tobi_world *w, const char *name, int components, tobi_moment *m, tobi_error *err)
{
    for (int k = 0; k < m->field_count; k++)
        if (strcmp(m->fields[k].name, name) == 0) return TOBI_OK;
    tobi_moment_field f = { strdup(name), components,
                            malloc((size_t)m->count*(size_t)components*sizeof(double) + 1) };
    tobi_status status = f.name && f.values
        ? tobi_world_read(w, TOBI_FLUID, name, f.values, m->count*components, err)
        : tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    if (status == TOBI_OK) {
        m->fields[m->field_count++] = f;
        return TOBI_OK;
    }
    free(f.name);
    free(f.values);
    return status;
}

/* Of each particle its fluid or solid, by its number among those of all systems. */
static tobi_status add_materials(const tobi_world *w, tobi_moment *m, tobi_error *err)
{
    tobi_moment_field f = { strdup("material"), 1, malloc((size_t)m->count*sizeof(double) + 1) };
    int64_t i = 0;
    if (!f.name || !f.values) {
        free(f.name);
        free(f.values);
        return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    }
    for (int k = 0; k < w->system_count; k++) {
        const tobi_system *s = &w->system[k];
        for (int64_t n = 0; n < s->particles.count && i < m->count; n++)      /* rows are fresh: just read */
            f.values[i++] = tobi_world_first_material(w, s) + s->particles.fluid[s->row_of[n]];
    }
    m->fields[m->field_count++] = f;
    return TOBI_OK;
}

static tobi_status take_fields(const tobi_run *run, tobi_world *w, tobi_moment *m, tobi_error *err)
{
    m->fields = calloc(9 + (size_t)run->view_count, sizeof *m->fields);
    if (!m->fields) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    TOBI_TRY(add_field(w, "velocity", 3, m, err));
    TOBI_TRY(add_materials(w, m, err));
    if (tobi_world_solids(w)) TOBI_TRY(add_field(w, "part", 1, m, err));
    if (w->solid_images > 0) TOBI_TRY(add_field(w, "rest_position", 3, m, err));
    if (tobi_record_has_pieces(w)) {
        TOBI_TRY(add_field(w, "piece", 1, m, err));
        TOBI_TRY(add_field(w, "particle_id", 1, m, err));
    }
    for (int k = 0; k < run->view_count; k++) {
        const tobi_record_field *f = &run->view[k].field;
        if (f->name) TOBI_TRY(add_field(w, f->name, f->components, m, err));
    }
    return TOBI_OK;
}

static int wants_nests(const tobi_run *run)
{
    int wanted = 0;
    for (int k = 0; k < run->view_count; k++) wanted |= run->view[k].def.nests;
    return wanted;
}

/* The positions are the snapshot's until there are others behind them: from then on the moment owns them. */
static tobi_status own_positions(tobi_moment *m, tobi_error *err)
{
    if (m->nest) return TOBI_OK;
    const size_t n = (size_t)m->count;
    double (*place)[3] = malloc(n*sizeof *place + 1);
    m->nest = calloc(n + 1, 1);
    if (!place || !m->nest) {
        free(place);
        free(m->nest);
        m->nest = NULL;
        return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    }
    if (n > 0) memcpy(place, m->positions, n*sizeof *place);
    m->positions = place;
    return TOBI_OK;
}

static tobi_status read_nest(const tobi_run *run, tobi_world *nest, tobi_moment *own, tobi_error *err)
{
    own->count = tobi_world_count(nest, TOBI_FLUID);
    own->positions = malloc((size_t)own->count*sizeof *own->positions + 1);
    if (!own->positions) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    TOBI_TRY(tobi_world_read(nest, TOBI_FLUID, "position", &own->positions[0][0], 3*own->count, err));
    return take_fields(run, nest, own, err);
}

/* Liquid of the nests that have come to the same time. A nest itself shows what is in its box. */
static tobi_status take_nests(const tobi_run *run, tobi_moment *m, tobi_error *err)
{
    double box[2][3], spacing;
    if (!wants_nests(run)) return TOBI_OK;
    if (tobi_world_nest_box(run->world, m->nests[0], &m->nest_spacing[0])) m->nest_count = 1;
    for (int k = 0; k < TOBI_NEST_LIMIT; k++) {
        tobi_world *nest = tobi_world_nest_at(run->world, k);
        if (!nest || !nest->started || !tobi_record_reaches(tobi_world_time(nest), m->time)) continue;
        if (!tobi_world_nest_box(nest, box, &spacing)) continue;
        tobi_moment own = { 0 };
        tobi_status status = own_positions(m, err);
        if (status == TOBI_OK) status = read_nest(run, nest, &own, err);
        if (status == TOBI_OK)
            status = tobi_moment_add_nest(m, &own, (const double (*)[3])box, spacing, err);
        tobi_moment_free(&own);
        TOBI_TRY(status);
    }
    return TOBI_OK;
}

/* Vertices are the snapshot's, triangles the world's; a body without vertices is absent. */
static tobi_status list_surfaces(const tobi_run *run, const tobi_snapshot *snapshot, tobi_moment *m,
                                 tobi_error *err)
{
    m->surfaces = calloc((size_t)(snapshot->surfaces + snapshot->lines) + 1, sizeof *m->surfaces);
    if (!m->surfaces) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    for (int b = 0; b < snapshot->surfaces; b++) {
        const tobi_mesh *mesh = &run->world->sim.bodies[b].mesh;
        if (!snapshot->surface[b]) continue;
        m->surfaces[m->surface_count++] = (tobi_moment_surface){
            run->body_file[b], mesh->vertex_count, mesh->triangle_count, snapshot->surface[b], mesh->triangles
        };
    }
    for (int k = 0; k < snapshot->lines; k++) {
        tobi_line_tube *t = &snapshot->tube[k];
        m->surfaces[m->surface_count++] = (tobi_moment_surface){
            run->line_file[k], TOBI_TUBE_VERTICES, TOBI_TUBE_TRIANGLES, t->vertex, t->triangle
        };
    }
    return TOBI_OK;
}

/* Tracks grow from output to output: those of earlier sessions are read. Each snapshot has a copy, because it
   is drawn later. */
static tobi_status take_tracks(tobi_run *run, tobi_moment *m, tobi_error *err)
{
    int wanted = 0;
    for (int k = 0; k < run->view_count; k++) wanted |= run->view[k].def.paths;
    if (!wanted) return TOBI_OK;
    if (run->tracks.track_count == 0 && run->outputs > 0) {
        run->tracks.time = tobi_record_time(run, run->outputs - 1);
        TOBI_TRY(tobi_tracks_read(run->dir, &run->tracks, err));
    }
    for (int b = 0; b < tobi_world_body_count(run->world); b++) {
        tobi_body_info info;
        TOBI_TRY(tobi_world_body(run->world, b, &info));
        TOBI_TRY(tobi_track_add(&run->tracks, tobi_world_body_name(run->world, b), info.position, err));
    }
    for (int k = 0; k < run->tracks.track_count; k++) {
        const tobi_moment_track *t = &run->tracks.tracks[k];
        for (int64_t i = 0; i < t->count; i++) TOBI_TRY(tobi_track_add(m, t->body, t->points[i], err));
    }
    return TOBI_OK;
}

/* Said once, at the start: pictures go on. */
static tobi_status note_camera(tobi_run *run, const tobi_drawing *d, int view, tobi_error *err)
{
    const char *body = tobi_drawing_body_around(d);
    char text[TOBI_NOTE];
    if (!body) return TOBI_OK;
    snprintf(text, sizeof text, tr("is inside of the body '%s', which hides all else from it\n"), body);
    return tobi_world_add_notes(run->world, "camera of", run->view[view].name, text, err);
}

tobi_status tobi_frames_take(tobi_run *run, tobi_snapshot *snapshot, tobi_error *err)
{
    tobi_moment *m = &snapshot->moment;
    TOBI_TRY(tobi_record_find_looks(run, err));
    m->time = tobi_world_time(run->world);
    m->count = snapshot->set[TOBI_SET_FLUID].count;
    m->positions = snapshot->set[TOBI_SET_FLUID].position;
    TOBI_TRY(take_fields(run, run->world, m, err));
    TOBI_TRY(take_nests(run, m, err));
    TOBI_TRY(list_surfaces(run, snapshot, m, err));
    TOBI_TRY(take_tracks(run, m, err));
    for (int k = 0; k < run->view_count; k++) {
        TOBI_TRY(tobi_drawing_make(&run->looks, m, &run->view[k].def, &snapshot->drawing[k], err));
        if (snapshot->number == 0) TOBI_TRY(note_camera(run, snapshot->drawing[k], k, err));
    }
    return TOBI_OK;
}

void tobi_frames_free(tobi_snapshot *s)
{
    for (int k = 0; k < 1 + TOBI_VIEW_LIMIT; k++) tobi_drawing_free(s->drawing[k]);
    for (int k = 0; k < s->moment.field_count; k++) {
        free(s->moment.fields[k].name);
        free(s->moment.fields[k].values);
    }
    for (int k = 0; k < s->moment.track_count; k++) free(s->moment.tracks[k].points);
    if (s->moment.nest) free(s->moment.positions);
    free(s->moment.nest);
    free(s->moment.tracks);
    free(s->moment.fields);
    free(s->moment.surfaces);
}

tobi_status tobi_frames_write(tobi_run *run, const tobi_snapshot *snapshot, int k, tobi_error *err)
{
    const double begun = tobi_record_clock();
    char *path = tobi_record_path(run->dir, "frames/%s_%06lld.png", run->view[k].name,
                                  (long long)snapshot->number);
    tobi_status status = path ? tobi_picture_write(path, tobi_drawing_picture(snapshot->drawing[k]), err)
                              : tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    free(path);
    if (status == TOBI_OK) {
        __atomic_fetch_add(&run->picture_ns, (int64_t)(1e9*(tobi_record_clock() - begun)), __ATOMIC_RELAXED);
        __atomic_fetch_add(&run->pictures, 1, __ATOMIC_RELAXED);
    }
    return status;
}

int64_t tobi_run_pictures(const tobi_run *run, double *seconds)
{
    if (seconds) *seconds = 0;
    if (!run) return 0;
    if (seconds) *seconds = 1e-9*(double)__atomic_load_n(&run->picture_ns, __ATOMIC_RELAXED);
    return __atomic_load_n(&run->pictures, __ATOMIC_RELAXED);
}
