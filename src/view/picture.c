/* The order of drawing: surfaces of the particles, shadows, what is opaque, water, lines and letters,
   over one canvas in memory. Drawback: everything is drawn on the processor. */
#define _GNU_SOURCE 1
#include "view/draw.h"
#include "tobiuo/overlay.h"
#include "view/skin.h"
#include "view/streamlines.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

tobi_picture tobi_default_picture(void)
{
    return (tobi_picture){
        .width = 1280, .height = 720, .samples = 2, .dimension = 3, .field_of_view = 30,
        .background_top = { 0.60f, 0.68f, 0.75f }, .background_bottom = { 0.90f, 0.92f, 0.93f }
    };
}

static tobi_status check_mesh(const char *path, const tobi_picture_mesh *m, int number, tobi_error *err)
{
    if ((m->vertex_count > 0 && !m->vertices) || (m->triangle_count > 0 && !m->triangles))
        return tobi_fail(err, TOBI_INVALID, "%s: body %d has no vertices or no triangles", path, number);
    for (int64_t t = 0; t < m->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            if (m->triangles[t][k] < 0 || m->triangles[t][k] >= m->vertex_count)
                return tobi_fail(err, TOBI_INVALID,
                                 "%s: triangle %" PRId64 " of body %d uses vertex %d of %" PRId64,
                                 path, t, number, (int)m->triangles[t][k], m->vertex_count);
    return TOBI_OK;
}

static tobi_status check_particles(const char *path, const tobi_picture *f, tobi_error *err)
{
    if (f->particle_count < 0 || f->particle_count > INT32_MAX || (f->particle_count > 0 && !f->positions))
        return tobi_fail(err, TOBI_INVALID, "%s: %" PRId64 " particles cannot be drawn", path,
                         f->particle_count);
    if (f->particle_count > 0 && !(f->radius > 0 && isfinite(f->radius)))
        return tobi_fail(err, TOBI_INVALID, "%s: a particle radius of %g m, must be greater than 0", path,
                         f->radius);
    for (int64_t i = 0; f->radii && i < f->particle_count; i++)
        if (!(f->radii[i] > 0 && f->radii[i] <= f->radius))
            return tobi_fail(err, TOBI_INVALID, "%s: particle %" PRId64 " has a radius of %g m, must be "
                             "greater than 0 and at most that of the picture, %g m", path, i, f->radii[i],
                             f->radius);
    return TOBI_OK;
}

static tobi_status check_frame(const char *path, const tobi_picture *f, tobi_error *err)
{
    if (f->width < 16 || f->height < 16 || f->width > 8192 || f->height > 8192)
        return tobi_fail(err, TOBI_INVALID, "%s: a picture of %d x %d pixels, allowed are 16 to 8192", path,
                         f->width, f->height);
    if (f->samples < 1 || f->samples > 4)
        return tobi_fail(err, TOBI_INVALID, "%s: %d samples per pixel and axis, allowed are 1 to 4", path,
                         f->samples);
    if (f->dimension != 2 && f->dimension != 3)
        return tobi_fail(err, TOBI_INVALID, "%s: dimension %d, allowed are 2 and 3", path, f->dimension);
    for (int k = 0; k < f->dimension; k++)
        if (!isfinite(f->box_min[k]) || !isfinite(f->box_max[k]) || !(f->box_min[k] < f->box_max[k]))
            return tobi_fail(err, TOBI_INVALID, "%s: the box is empty along %c", path, "xyz"[k]);
    TOBI_TRY(check_particles(path, f, err));
    if (f->foam_count < 0 || f->foam_count > INT32_MAX || (f->foam_count > 0 && !f->foam))
        return tobi_fail(err, TOBI_INVALID, "%s: %" PRId64 " points of foam cannot be drawn", path,
                         f->foam_count);
    if (f->dimension == 3 && !(f->field_of_view >= 1 && f->field_of_view <= 150))
        return tobi_fail(err, TOBI_INVALID, "%s: a field of view of %g degrees, allowed are 1 to 150", path,
                         f->field_of_view);
    if (f->look < TOBI_LOOK_NATURAL || f->look > TOBI_LOOK_PARTICLES)
        return tobi_fail(err, TOBI_INVALID, "%s: there is no look %d", path, f->look);
    const double *n = f->clip_normal;
    if (f->clip && !(n[0]*n[0] + n[1]*n[1] + n[2]*n[2] > 0 && isfinite(n[0] + n[1] + n[2])))
        return tobi_fail(err, TOBI_INVALID, "%s: the normal of the clip plane has no direction", path);
    if (f->isolines < 0 || f->isolines > 100)
        return tobi_fail(err, TOBI_INVALID, "%s: %d isolines, allowed are 0 to 100", path, f->isolines);
    if (f->streamlines < 0 || f->streamlines > 200)
        return tobi_fail(err, TOBI_INVALID, "%s: %d streamlines, allowed are 0 to 200", path, f->streamlines);
    if (f->path_count < 0 || (f->path_count > 0 && !f->paths))
        return tobi_fail(err, TOBI_INVALID, "%s: %d paths cannot be drawn", path, f->path_count);
    if (f->palette && f->palette_count < 1)
        return tobi_fail(err, TOBI_INVALID, "%s: a palette of %d colours, at least 1", path,
                         f->palette_count);
    if (f->mesh_count < 0 || (f->mesh_count > 0 && !f->meshes))
        return tobi_fail(err, TOBI_INVALID, "%s: %d bodies cannot be drawn", path, f->mesh_count);
    for (int i = 0; i < f->mesh_count; i++) TOBI_TRY(check_mesh(path, &f->meshes[i], i, err));
    return TOBI_OK;
}

const char *tobi_picture_stage_name(int stage)
{
    static const char *const names[TOBI_PICTURE_STAGES] = {
        "surfaces of particles", "shadows", "bodies and solids", "water", "lines and letters", "PNG"
    };
    return stage >= 0 && stage < TOBI_PICTURE_STAGES ? names[stage] : NULL;
}

const tile_kernels *tile_kernels_for(int isa) { return TOBI_TABLE_OF(isa, tile_kernels); }

/* All that is drawn. */
typedef struct scene {
    const tobi_picture *f;
    canvas c;
    geometry solids, water, drops, glass;
    vec *color;                  /* of particles, or their scaled values; NULL: water's */
    vec scale[SCALE_STEPS + 1];  /* of values, for surfaces in their colours    */
    segments isolines, outline;
    segments cover[COVERS];      /* in 2-D: of bodies and solids                */
    int32_t *row;                /* of particles                                */
    vec *rest;                   /* of particles, see view_fit_rest; NULL: no skin */
    double low, high;            /* values of the colour map's ends             */
    double clock;                /* s, when the stage began                     */
} scene;

enum { STAGE_SURFACE, STAGE_SHADOW, STAGE_SOLIDS, STAGE_WATER, STAGE_LINES, STAGE_PNG };

static double processor_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9*(double)now.tv_nsec;
}

static void end_stage(scene *s, int stage)
{
    if (!s->f || !s->f->stage_seconds) return;
    const double now = processor_clock();
    s->f->stage_seconds[stage] = now - s->clock;
    s->clock = now;
}

static void free_scene(scene *s)
{
    free(s->c.color);
    free(s->c.alpha);
    free(s->c.depth);
    free(s->c.front);
    free(s->c.nearness);
    free(s->c.covered);
    free(s->c.shadow.depth);
    free(s->c.shadow.range);
    tobi_letters_close(s->c.letters);
    view_geometry_free(&s->solids);
    view_geometry_free(&s->water);
    view_geometry_free(&s->drops);
    view_geometry_free(&s->glass);
    free(s->color);
    free(s->row);
    free(s->rest);
    free(s->c.images);
    free(s->c.inside);
    free(s->isolines.end);
    free(s->outline.end);
    for (int k = 0; k < COVERS; k++) free(s->cover[k].end);
}

static tobi_status no_memory(const tobi_picture *f, tobi_error *err)
{
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture of %d x %d pixels", f->width, f->height);
}

/* Surfaces in the colours of values: those are interpolated, not the colours. */
static bool is_scaled(const tobi_picture *f)
{
    return f->dimension == 3 && f->look == TOBI_LOOK_SURFACE && f->values && f->particle_count > 0;
}

/* Of meshes and skins, and where particles were at rest. */
static tobi_status take_images(scene *s, tobi_error *err)
{
    const tobi_picture *f = s->f;
    canvas *c = &s->c;
    const bool skins = f->skin_count > 0 && f->skin && f->rest && !f->look;
    const size_t count = (size_t)f->mesh_count + (skins ? (size_t)f->skin_count : 0) + 1;
    c->images = calloc(count, sizeof *c->images);
    c->inside = calloc(count, sizeof *c->inside);
    if (skins) s->rest = malloc(((size_t)f->particle_count + 1)*sizeof *s->rest);
    if (!c->images || !c->inside || (skins && !s->rest)) return no_memory(f, err);
    for (int k = 0; k < f->mesh_count; k++) {
        c->images[k] = f->meshes[k].uv ? f->meshes[k].image : NULL;
        c->inside[k] = linear_color(f->meshes[k].color);
    }
    for (int k = 0; skins && k < f->skin_count; k++) {
        c->images[f->mesh_count + k] = f->skins[k].image;
        c->inside[f->mesh_count + k] = linear_color(f->skins[k].inside);
    }
    return TOBI_OK;
}

static tobi_status make_canvas(scene *s, tobi_error *err)
{
    const tobi_picture *f = s->f;
    canvas *c = &s->c;
    tobi_exec exec;
    TOBI_TRY(tobi_exec_init(&exec, f->threads, err));
    *c = (canvas){ .width = f->width, .height = f->height, .samples = f->samples, .threads = f->threads,
                   .kernels = tile_kernels_for(exec.isa) };
    tobi_exec_free(&exec);
    double size = 0;
    for (int k = 0; k < 3; k++) size += (f->box_max[k] - f->box_min[k])*(f->box_max[k] - f->box_min[k]);
    c->clarity = f->clarity > 0 ? (float)f->clarity : (float)(0.16*sqrt(size));
    if ((f->title || f->label || f->axes) && !view_open_letters(&c->letters)) return no_memory(f, err);
    TOBI_TRY(take_images(s, err));
    const size_t n = (size_t)c->width*(size_t)c->height;
    c->color = malloc(n*sizeof *c->color);
    c->depth = malloc(n*sizeof *c->depth);
    s->row = malloc(((size_t)f->particle_count + 1)*sizeof *s->row);
    view_find_range(f, &s->low, &s->high);
    if (is_scaled(f)) {
        view_make_scale(f, s->scale);
        s->color = view_scale_particles(f, s->low, s->high);
    } else if (f->values && f->particle_count > 0) s->color = view_color_particles(f, s->low, s->high);
    return c->color && c->depth && s->row && (s->color || !f->values || f->particle_count == 0) ? TOBI_OK
        : no_memory(f, err);
}

/* The particles that are opaque, or those that are not. */
static surface_request choose(scene *s, bool opaque)
{
    const tobi_picture *f = s->f;
    surface_request r = { .f = f, .row = s->row, .color = s->color, .level = 0.5f,
                          .plain = { 0.006f, 0.095f, 0.180f } };
    if (is_scaled(f)) r.scale = s->scale;
    if (is_scaled(f) && f->isolines > 0) r.isolines = &s->isolines;
    for (int64_t i = 0; i < f->particle_count; i++)
        if (view_beyond(f, f->positions[i], 0.5*f->slice) <= 12*f->radius      /* what its surface needs */
            && (f->look || (f->opaque && f->opaque[i])) == opaque) s->row[r.count++] = (int32_t)i;
    return r;
}

static int compare_keys(const void *a, const void *b)
{
    const uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return p < q ? -1 : p > q;
}

/* Particles of one group lie side by side. */
static bool sort_by_group(const tobi_picture *f, surface_request *r, int32_t *row)
{
    uint64_t *key = malloc(((size_t)r->count + 1)*sizeof *key);
    if (!key) return false;
    for (int64_t i = 0; i < r->count; i++)
        key[i] = ((uint64_t)(uint32_t)f->group[row[i]] ^ 0x80000000u) << 32 | (uint32_t)row[i];
    qsort(key, (size_t)r->count, sizeof *key, compare_keys);
    for (int64_t i = 0; i < r->count; i++) row[i] = (int32_t)(uint32_t)key[i];
    free(key);
    return true;
}

static double radius_of(const tobi_picture *f, int64_t i) { return f->radii ? f->radii[i] : f->radius; }

/* Of sorted particles those of a group, from *begin on; *begin becomes its end. */
static surface_request take_group(const surface_request *all, int64_t *begin)
{
    const tobi_picture *f = all->f;
    const int32_t *row = all->row;
    int64_t end = *begin + 1;
    while (end < all->count && (!f->group || f->group[row[end]] == f->group[row[*begin]])) end++;
    surface_request r = *all;
    r.row += *begin, r.count = end - *begin;
    r.radius = radius_of(f, r.row[0]);
    r.nest = view_nest_of(f, r.row[0]);
    r.drop *= (float)r.radius;
    if (view_has_own(f, r.row[0])) r.scale = NULL;
    *begin = end;
    return r;
}

/* A surface around each group of particles, in 2-D a region; all.drop is in radii; *within: the eye is in
   one. */
static tobi_status add_groups(scene *s, surface_request all, geometry *g, geometry *drops, bool *within,
                              tobi_error *err)
{
    const tobi_picture *f = s->f;
    *within = false;
    if (f->group && !sort_by_group(f, &all, s->row)) return no_memory(f, err);
    for (int64_t begin = 0; begin < all.count;) {
        bool around;
        surface_request r = take_group(&all, &begin);
        const int skin = s->rest ? f->skin[r.row[0]] : -1;
        rest_map map;
        if (skin >= 0 && skin < f->skin_count && f->skins[skin].image) {
            view_fit_rest(f->positions, f->rest, r.row, r.count, &map, s->rest);
            r.skin = &f->skins[skin], r.skin_number = f->mesh_count + skin, r.color = s->rest, r.map = &map;
        }
        if (f->dimension == 2) {
            r.evens = f->opaque && f->opaque[r.row[0]];
            if (r.evens) r.level = view_even_level(2);
            TOBI_TRY(view_add_region(g, &s->c, &r, err));
            continue;
        }
        if (r.evens) r.joins = !(f->opaque && f->opaque[r.row[0]]);      /* water in the colours of a field */
        TOBI_TRY(view_add_surface(g, drops, &s->c, &r, &around, err));
        *within |= around;
    }
    return TOBI_OK;
}

static tobi_status add_solids(scene *s, tobi_error *err)
{
    surface_request all = choose(s, true);
    bool within;
    all.plain = (vec){ 0.20f, 0.30f, 0.45f };
    all.level = view_even_level(3);
    all.evens = true;
    all.drop = 1.1f;
    return add_groups(s, all, &s->solids, &s->solids, &within, err);
}

/* Every particle as a ball. */
static tobi_status add_particles(scene *s, tobi_error *err)
{
    const tobi_picture *f = s->f;
    geometry *g = &s->solids;
    if (!view_reserve(g, 0, 0, f->particle_count)) return no_memory(f, err);
    for (int64_t i = 0; i < f->particle_count; i++) {
        const vec p = view_point(&s->c.camera, f->positions[i]);
        if (!view_is_shown(f, i) || !(fabsf(p.x) + fabsf(p.y)
                                      + fabsf(p.z) < 1e15f*(float)f->radius)) continue;
        const vec color = s->color ? s->color[i] : view_color_of(f, 0);
        g->balls[g->ball_count++] = (ball){ p, (float)radius_of(f, i), color };
    }
    return TOBI_OK;
}

/* A vessel would hide its water in 2-D, where all is seen from the front: there it is an outline. */
static bool add_body(scene *s, int i)
{
    const tobi_picture_mesh *m = &s->f->meshes[i];
    const bool clear = m->transparency > 0;
    const float depth = clear ? -logf(clampf(m->transparency, 0.004f, 0.996f)) : 1;
    if (s->f->dimension == 2 && !view_add_section(&s->cover[m->hollow || clear ? COVER_CLEAR : COVER_OPAQUE],
                                                  &s->c, m)) return false;
    if (m->hollow && s->f->dimension == 2)
        return view_add_outline(&s->solids, &s->c, m, 0.5f*(float)s->f->radius);
    return view_add_mesh(clear ? &s->glass : &s->solids, &s->c, m, s->c.images[i] ? i : -1,
                         !m->hollow && !clear, depth);
}

/* Those whose cut is filled come first. */
static tobi_status add_bodies(scene *s, tobi_error *err)
{
    const tobi_picture *f = s->f;
    for (int hollow = 0; hollow < 2; hollow++) {
        for (int i = 0; i < f->mesh_count; i++)
            if ((f->meshes[i].hollow != 0) == hollow && !add_body(s, i)) return no_memory(f, err);
        if (!hollow) s->solids.filled = s->solids.faces;
    }
    return view_project(&s->glass, &s->c.camera, f->threads, err);
}

static tobi_status add_surfaces(scene *s, tobi_error *err)
{
    const tobi_picture *f = s->f;
    TOBI_TRY(add_bodies(s, err));
    if (f->look == TOBI_LOOK_PARTICLES) {
        TOBI_TRY(add_particles(s, err));
        return view_project(&s->solids, &s->c.camera, f->threads, err);
    }
    if (f->opaque || f->look) TOBI_TRY(add_solids(s, err));
    surface_request r = choose(s, false);
    r.drop = 0.9f;
    r.joins = true;
    TOBI_TRY(add_groups(s, r, &s->water, &s->drops, &s->c.submerged, err));
    TOBI_TRY(view_project(&s->solids, &s->c.camera, f->threads, err));
    return view_project(&s->water, &s->c.camera, f->threads, err);
}

/* Every particle as a disc over a larger, darker one that closes the gaps. */
static tobi_status add_discs(scene *s, tobi_error *err)
{
    const tobi_picture *f = s->f;
    const float size = (float)(f->box_max[0] - f->box_min[0] + f->box_max[1] - f->box_min[1]);
    geometry *g = &s->solids;
    if (!view_reserve(g, 0, 0, 2*f->particle_count)) return no_memory(f, err);
    for (int64_t i = 0; i < f->particle_count; i++) {
        vec p = view_point(&s->c.camera, f->positions[i]);
        if (!view_is_shown(f, i) || !(fabsf(p.x) + fabsf(p.y) < 1e9f)) continue;
        for (int k = 0; k < 2; k++) {
            p.z = size*(float)(k + 10);
            const vec color = s->color ? s->color[i] : view_color_of(f, 0);
            g->balls[g->ball_count++] = (ball){ p, (k ? 1.45f : 0.95f)*(float)radius_of(f, i),
                                                vec_scale(k ? 0.8f : 1, color) };
        }
    }
    return TOBI_OK;
}

/* Of solids, then of liquids, which reach up to those and to bodies. */
static tobi_status add_regions(scene *s, tobi_error *err)
{
    const tobi_picture *f = s->f;
    for (int opaque = f->opaque ? 1 : 0; opaque >= 0; opaque--) {
        surface_request all = { .f = f, .row = s->row, .color = s->color, .level = 0.5f,
                                .outline = &s->outline };
        bool within;
        all.plain = view_color_of(f, 0);
        all.cover = opaque ? NULL : s->cover;
        if (!opaque && f->group && !f->nest) all.liquid = s->row;
        for (int64_t i = 0; i < f->particle_count; i++)
            if (view_beyond(f, f->positions[i], 0.5*f->slice) <= 12*f->radius
                && (f->opaque && f->opaque[i]) == opaque) s->row[all.count++] = (int32_t)i;
        all.liquids = all.count;
        TOBI_TRY(add_groups(s, all, &s->solids, &s->solids, &within, err));
        for (int64_t k = 0; opaque && k < s->outline.count; k++)
            if (!view_add_segment(&s->cover[COVER_OPAQUE], s->outline.end[k][0], s->outline.end[k][1]))
                return no_memory(f, err);
    }
    return TOBI_OK;
}

static tobi_status add_isolines(scene *s, tobi_error *err)
{
    const tobi_picture *f = s->f;
    surface_request all = { .f = f, .row = s->row };
    for (int64_t i = 0; i < f->particle_count; i++) s->row[all.count++] = (int32_t)i;
    if (f->group && !sort_by_group(f, &all, s->row)) return no_memory(f, err);
    for (int64_t begin = 0; begin < all.count;) {
        const surface_request r = take_group(&all, &begin);
        if (view_has_own(f, r.row[0])) continue;
        if (!view_find_isolines(&s->c, &r, s->low, s->high, &s->isolines)) return no_memory(f, err);
    }
    return TOBI_OK;
}

static tobi_status add_flat(scene *s, tobi_error *err)
{
    const tobi_picture *f = s->f;
    TOBI_TRY(add_bodies(s, err));
    TOBI_TRY(f->look == TOBI_LOOK_PARTICLES ? add_discs(s, err) : add_regions(s, err));
    if (f->isolines > 0 && f->values) TOBI_TRY(add_isolines(s, err));
    return view_project(&s->solids, &s->c.camera, f->threads, err);
}

typedef struct copying { canvas *c; const vec *from; } copying;

static void copy_water(const void *view, int64_t begin, int64_t end)
{
    const copying *v = view;
    for (int64_t k = begin*v->c->width; k < end*v->c->width; k++)
        if (v->c->front[k] < INFINITY) v->c->color[k] = v->from[k];
}

static tobi_status draw_water(scene *s, tobi_error *err)
{
    canvas *c = &s->c;
    vec *out = malloc((size_t)c->width*(size_t)c->height*sizeof *out);
    if (!out) return no_memory(s->f, err);
    const tobi_status status = view_paint(c, &s->water, c->kernels->water_tiles, out, err);
    const copying view = { c, out };
    if (status == TOBI_OK) tobi_loop(c->threads, c->height, 0, copy_water, &view);
    free(out);
    if (status != TOBI_OK || s->drops.ball_count == 0) return status;
    return view_paint(c, &s->drops, c->kernels->drop_tiles, c->color, err);
}

static bool has_water(const scene *s) { return s->water.faces > 0 || s->drops.ball_count > 0; }

/* What the water's samples are compared with. */
static tobi_status make_water_planes(scene *s, tobi_error *err)
{
    canvas *c = &s->c;
    const int64_t across = (c->width + TILE - 1)/TILE, down = (c->height + TILE - 1)/TILE;
    const int64_t n = across*down*TILE*TILE*c->samples*c->samples;
    c->front = malloc((size_t)c->width*(size_t)c->height*sizeof *c->front);
    c->nearness = malloc((size_t)n*sizeof *c->nearness);
    c->covered = malloc((size_t)(across*down));
    return c->front && c->nearness && c->covered ? TOBI_OK : no_memory(s->f, err);
}

/* Seen through water. */
static bool draw_path(canvas *c, const tobi_picture_path *path)
{
    segments parts = { .count = 0 };
    bool enough = true;
    for (int64_t k = 1; enough && k < path->count; k++)
        enough = view_add_segment(&parts, view_point(&c->camera, path->points[k - 1]),
                                  view_point(&c->camera, path->points[k]));
    enough = enough && view_draw_segments(c, &parts, 2.2f, linear_color(path->color), 0.9f);
    free(parts.end);
    return enough;
}

static tobi_status draw_lines(scene *s, tobi_error *err)
{
    const tobi_picture *f = s->f;
    const vec dark = { 0.01f, 0.01f, 0.02f };
    bool enough = view_draw_segments(&s->c, &s->outline, 1, dark, 0.5f) &&
                  view_draw_segments(&s->c, &s->isolines, 1.2f, dark, 0.8f);
    for (int n = 0; enough && n < f->path_count; n++) enough = draw_path(&s->c, &f->paths[n]);
    return enough ? TOBI_OK : no_memory(f, err);
}

static tobi_status draw(scene *s, const char *path, tobi_error *err)
{
    const tobi_picture *f = s->f;
    canvas *c = &s->c;
    TOBI_TRY(view_aim(c, path, f, err));
    view_find_cut(c, f);
    TOBI_TRY(f->dimension == 3 ? add_surfaces(s, err) : add_flat(s, err));
    if (has_water(s)) TOBI_TRY(make_water_planes(s, err));
    end_stage(s, STAGE_SURFACE);
    if (f->dimension == 3) TOBI_TRY(view_make_shadow(c, f, &s->solids, err));
    end_stage(s, STAGE_SHADOW);
    view_draw_background(c, f);
    view_draw_floor(c, f);
    TOBI_TRY(view_paint(c, &s->solids, c->kernels->opaque_tiles, c->color, err));
    view_draw_box(c, f, false);
    const geometry *water = s->water.faces > 0 ? &s->water : NULL;
    const float film = 2*(float)f->radius;
    if (s->glass.faces > 0 && (water || c->submerged))
        TOBI_TRY(view_paint_glass(c, &s->glass, water, false, film, err));
    end_stage(s, STAGE_SOLIDS);
    if (has_water(s)) TOBI_TRY(draw_water(s, err));
    TOBI_TRY(view_draw_foam(c, f, err));
    end_stage(s, STAGE_WATER);
    if (c->front) view_draw_box(c, f, true);
    if (s->glass.faces > 0) TOBI_TRY(view_paint_glass(c, &s->glass, water, true, film, err));
    view_draw_zones(c, f);
    TOBI_TRY(draw_lines(s, err));
    if (f->streamlines > 0 && f->flow && !view_draw_streamlines(c, f)) return no_memory(f, err);
    if (f->velocities && !view_draw_arrows(c, f)) return no_memory(f, err);
    if (f->axes) view_draw_axes(c, f);
    if (f->title) view_draw_title(c, f->title);
    if (f->label) view_draw_color_bar(c, f, s->low, s->high);
    end_stage(s, STAGE_LINES);
    return TOBI_OK;
}

/* name: begins messages. The caller frees the scene, on failure too. */
static tobi_status draw_scene(scene *s, const char *name, const tobi_picture *frame, tobi_error *err)
{
    *s = (scene){ .f = frame, .clock = processor_clock() };
    TOBI_TRY(check_frame(name, frame, err));
    TOBI_TRY(make_canvas(s, err));
    return draw(s, name, err);
}

/* Drawn before black and before white: the difference is what shines through. */
static tobi_status draw_transparent(scene *s, const char *name, const tobi_picture *frame, tobi_error *err)
{
    tobi_picture f = *frame;
    scene white;
    for (int k = 0; k < 3; k++) f.background_top[k] = f.background_bottom[k] = 1;
    tobi_status status = draw_scene(&white, name, &f, err);
    for (int k = 0; k < 3; k++) f.background_top[k] = f.background_bottom[k] = 0;
    if (status == TOBI_OK) status = draw_scene(s, name, &f, err);
    const size_t n = (size_t)f.width*(size_t)f.height;
    s->f = frame;
    if (status == TOBI_OK && !(s->c.alpha = malloc(n*sizeof *s->c.alpha))) status = no_memory(frame, err);
    for (size_t k = 0; status == TOBI_OK && k < n; k++) {
        vec *color = &s->c.color[k];
        const vec through = vec_sub(white.c.color[k], *color);
        const float alpha = clampf(1 - (through.x + through.y + through.z)/3, 0, 1);
        s->c.alpha[k] = alpha;
        *color = vec_scale(alpha > 0 ? 1/alpha : 0, *color);
    }
    free_scene(&white);
    return status;
}

tobi_status tobi_picture_write(const char *path, const tobi_picture *frame, tobi_error *err)
{
    TOBI_NEED(path, "the path");
    TOBI_NEED(frame, "the picture");
    scene s = { 0 };
    tobi_status status = frame->transparent ? draw_transparent(&s, path, frame, err)
        : draw_scene(&s, path, frame, err);
    if (status == TOBI_OK) status = view_write_png(path, &s.c, err);
    end_stage(&s, STAGE_PNG);
    free_scene(&s);
    return status;
}

tobi_status tobi_picture_draw(const tobi_picture *frame, uint8_t *rgb, tobi_error *err)
{
    TOBI_NEED(frame, "the picture");
    TOBI_NEED(rgb, "the place for its pixels");
    scene s;
    tobi_status status = draw_scene(&s, "picture", frame, err);
    if (status == TOBI_OK) view_encode_colors(&s.c, 3, rgb);
    free_scene(&s);
    return status;
}
