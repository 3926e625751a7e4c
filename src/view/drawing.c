/* From a moment of a run to the picture of it: colours of materials and fields, hidden things, bodies.
   Drawback: positions are copied for each view. */
#include "tobiuo/drawing.h"
#include "base/error.h"
#include "view/draw.h"
#include "view/drawing.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void tobi_drawing_free(tobi_drawing *d)
{
    if (!d) return;
    free(d->positions);
    free(d->velocities);
    free(d->values);
    free(d->own);
    free(d->palette);
    free(d->tint);
    free(d->opaque);
    free(d->group);
    free(d->radii);
    free(d->nest);
    free(d->meshes);
    free(d->paths);
    free(d->skins);
    free(d->skin);
    free(d->rest);
    free(d->edges);
    free(d);
}

tobi_picture *tobi_drawing_picture(tobi_drawing *d) { return d ? &d->picture : NULL; }

void tobi_looks_free(tobi_looks *looks)
{
    if (!looks) return;
    for (int k = 0; looks->materials && k < looks->material_count; k++) {
        tobi_material_look *m = &looks->materials[k];
        tobi_image_free(m->image);
        if (m->free_skin) m->free_skin(m->skin_user);
    }
    for (int k = 0; looks->bodies && k < looks->body_count; k++) {
        tobi_image_free(looks->bodies[k].image);
        free(looks->bodies[k].uv);
    }
    for (int k = 0; looks->inlets && k < looks->inlet_count; k++) free(looks->inlets[k].flows);
    free(looks->materials);
    free(looks->bodies);
    free(looks->inlets);
    free(looks->zones);
    free(looks->edges);
    free(looks->carried);
    *looks = (tobi_looks){ 0 };
}

static int flows_at(const tobi_inlet_look *in, double time)
{
    int flows = 0;
    for (int k = 0; k < in->flow_count; k++) {
        const double slack = 1e-9*(1 + fabs(time));      /* times in files are rounded */
        flows |= time >= in->flows[k][0] - slack && time < in->flows[k][1] - slack;
    }
    return flows;
}

int tobi_looks_hides(const tobi_looks *looks, double time, const double x[3])
{
    for (int k = 0; looks && x && k < looks->inlet_count; k++) {
        const tobi_inlet_look *in = &looks->inlets[k];
        const double slack = 1e-9;      /* m */
        double at[3] = { 0, 0, 0 };
        for (int a = 0; a < 3; a++) {
            const double arm = x[a] - in->centre[a];
            at[0] += arm*in->normal[a], at[1] += arm*in->along[a], at[2] += arm*in->across[a];
        }
        const int faces = in->radius > 0 ? at[1]*at[1] + at[2]*at[2] <= in->radius*in->radius + slack
            : fabs(at[1]) <= in->half[0] + slack && fabs(at[2]) <= in->half[1] + slack;
        if (faces && at[0] < 0 && at[0] >= -in->depth && !flows_at(in, time)) return 1;
    }
    return 0;
}

int tobi_looks_differ(const tobi_looks *looks)
{
    int differ = 0;
    for (int k = 0; looks && k < looks->material_count; k++)
        differ |= tobi_looks_radius(looks, k) != 0.5*looks->spacing;
    return differ;
}

double tobi_looks_radius(const tobi_looks *looks, int material)
{
    const int known = looks && material >= 0 && material < looks->material_count;
    const double own = known ? looks->materials[material].spacing : 0;
    return 0.5*(own > 0 ? own : looks ? looks->spacing : 0);
}

static tobi_status no_memory(tobi_error *err)
{
    return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
}

static const tobi_moment_field *find_field(const tobi_moment *m, const char *name)
{
    for (int k = 0; k < m->field_count; k++)
        if (strcmp(m->fields[k].name, name) == 0) return &m->fields[k];
    return NULL;
}

static int number_at(const tobi_moment_field *f, int64_t i, int otherwise)
{
    const double v = f ? f->values[i*f->components] : otherwise;
    return v > -1e9 && v < 1e9 ? (int)v : otherwise;
}

/* In 2-D the vorticity is along z: its sign is the sense of the turn. */
static int is_turn(const tobi_looks *looks, const char *field)
{
    return looks->dimension == 2 && field && strcmp(field, "vorticity") == 0;
}

/* In floats, as files have it. */
double tobi_drawing_value(const tobi_looks *looks, const tobi_moment_field *f, int64_t i)
{
    if (!f) return 0;
    const double *v = f->values + i*f->components;
    double square = 0;
    if (f->components == 1) return (float)*v;
    if (f->components == 3 && is_turn(looks, f->name)) return (float)v[2];
    for (int k = 0; k < f->components; k++) square += (double)(float)v[k]*(double)(float)v[k];
    return (float)sqrt(square);
}

static const tobi_material_look *look_of(const tobi_looks *s, int material)
{
    static const tobi_material_look plain = { .color = { -1, -1, -1 }, .core_color = { -1, -1, -1 },
                                              .visible = 1, .liquid = 1 };
    return material >= 0 && material < s->material_count ? &s->materials[material] : &plain;
}

/* Of solids with a texture, if the output says where their particles were at rest. */
static tobi_status make_skins(tobi_drawing *d, tobi_error *err)
{
    const tobi_looks *s = d->looks;
    const size_t n = (size_t)d->moment->count + 1;
    int images = 0;
    for (int k = 0; k < s->material_count; k++) images += s->materials[k].skin.image != NULL;
    if (images == 0 || !d->has_palette || !d->at_rest || d->at_rest->components != 3) return TOBI_OK;
    d->skins = calloc((size_t)s->material_count, sizeof *d->skins);
    d->skin = malloc(n*sizeof *d->skin);
    d->rest = malloc(n*sizeof *d->rest);
    if (!d->skins || !d->skin || !d->rest) return no_memory(err);
    for (int k = 0; k < s->material_count; k++) {
        float color[4];
        d->skins[k] = s->materials[k].skin;
        tobi_looks_color(s, k, 1, color);      /* of the core */
        memcpy(d->skins[k].inside, color, sizeof d->skins[k].inside);
    }
    return TOBI_OK;
}

static void take_skin(tobi_drawing *d, int64_t i, int64_t to, int material)
{
    const int known = material >= 0 && material < d->looks->material_count;
    d->skin[to] = (int16_t)(known && d->skins[material].image ? material : -1);
    memcpy(d->rest[to], d->at_rest->values + 3*i, sizeof d->rest[to]);
}

static tobi_status make_arrays(tobi_drawing *d, int arrows, tobi_error *err)
{
    const size_t n = (size_t)d->moment->count + 1;
    const int nests = d->view->nests && d->moment->nest_count > 0;
    const int differ = tobi_looks_differ(d->looks) || nests;
    const int own = d->view->field_of && d->looks->material_count > 0;
    d->positions = malloc(n*sizeof *d->positions);
    d->values = malloc(n*sizeof *d->values);
    d->opaque = malloc(n);
    d->group = malloc(n*sizeof *d->group);
    if (arrows) d->velocities = malloc(n*sizeof *d->velocities);
    if (differ) d->radii = malloc(n*sizeof *d->radii);
    if (own) d->own = malloc(n*sizeof *d->own);
    if (nests) d->nest = malloc(n);
    const int enough = d->positions && d->values && d->opaque && d->group && (!arrows || d->velocities) &&
                       (!differ || d->radii) && (!own || d->own) &&
                       (!nests || d->nest);
    return enough ? TOBI_OK : no_memory(err);
}

/* Of particles that do not show the field; of the others a red below 0. */
static void take_own_color(tobi_drawing *d, int64_t to, int color)
{
    static const float none[3] = { -1, -1, -1 };
    const int shows = d->opaque[to] == (d->view->field_of == TOBI_FIELD_OF_SOLIDS);
    memcpy(d->own[to], shows ? none : d->palette[color], sizeof none);
}

/* Without nests what is theirs is left out, with them what surfaces do not need. */
static int is_taken(const tobi_drawing *d, int64_t i)
{
    const tobi_moment *m = d->moment;
    const int nest = view_moment_nest(m, i);
    if (!d->nest) return nest == 0 || !m->nest;
    const double spacing = nest ? m->nest_spacing[nest - 1] : d->looks->spacing;
    const double most = d->view->look == TOBI_LOOK_PARTICLES ? 0 : VIEW_NEST_MARGIN*spacing;
    return view_beyond_nests((const double (*)[2][3])m->nests, m->nest_count, nest, m->positions[i]) <= most;
}

/* Its own size; liquids of different nests have different surfaces. */
static void take_nest(tobi_drawing *d, int64_t i, int64_t to)
{
    const int nest = view_moment_nest(d->moment, i);
    d->nest[to] = (uint8_t)nest;
    if (nest) d->radii[to] = 0.5*d->moment->nest_spacing[nest - 1];
    d->group[to] -= nest*(d->looks->material_count + 1);
}

/* A value for each particle that is shown, its place and velocity. */
static tobi_status take_particles(tobi_drawing *d, tobi_error *err)
{
    const tobi_moment *m = d->moment;
    const tobi_moment_field *velocity = find_field(m, "velocity");
    int component = -1;
    const char *whole = tobi_world_find_field(d->view->field, &component, NULL);
    const char *name = whole ? whole : d->view->field ? d->view->field : "velocity";
    const tobi_moment_field *field = find_field(m, name);
    if (d->view->field && !field)
        return tobi_fail(err, TOBI_NOT_FOUND, "the output has no field '%s'; a run writes it with "
                         "\"fields\": [\"usual\", \"%s\"] in output of the scene", name, name);
    const int arrows = (d->view->arrows || d->view->streamlines > 0) && velocity;
    TOBI_TRY(make_arrays(d, arrows, err));
    TOBI_TRY(make_skins(d, err));
    for (int64_t i = 0; i < m->count; i++) {
        const int material = number_at(d->material, i, 0), piece = number_at(d->piece, i, -1);
        const tobi_material_look *look = look_of(d->looks, material);
        if (!look->visible || tobi_looks_hides(d->looks, m->time, m->positions[i])) continue;
        if (!is_taken(d, i)) continue;
        const int64_t to = d->count++;
        memcpy(d->positions[to], m->positions[i], sizeof *d->positions);
        for (int k = 0; arrows && k < 3; k++) d->velocities[to][k] = (float)velocity->values[3*i + k];
        d->opaque[to] = !look->liquid;
        if (d->radii) d->radii[to] = tobi_looks_radius(d->looks, material);
        if (d->skin) take_skin(d, i, to, material);
        d->group[to] = look->liquid ? -look->kind : piece >= 0 ? 1 + piece : -material;
        if (d->nest) take_nest(d, i, to);
        const int color = tobi_drawing_color(d, material, number_at(d->part, i, 0), piece);
        d->values[to] = d->has_palette ? (float)color
                      : component >= 0 && component < field->components
                      ? (float)field->values[i*field->components + component]
                      : (float)tobi_drawing_value(d->looks, field, i);
        if (d->own) take_own_color(d, to, color);
    }
    return TOBI_OK;
}

int tobi_drawing_find_body(const tobi_looks *s, const char *name)
{
    for (int k = 0; name && k < s->body_count; k++)
        if (strcmp(s->bodies[k].name, name) == 0) return k;
    for (int k = 0; name && k < s->body_count; k++)
        if (strcmp(s->bodies[k].body, name) == 0) return k;
    return -1;
}

/* Of body b, or without one by a number. */
static void find_color(const tobi_looks *looks, int b, int number, float out[3])
{
    static const float colors[][3] = { { 0.93f, 0.62f, 0.28f }, { 0.80f, 0.33f, 0.36f },
                                       { 0.55f, 0.70f, 0.35f }, { 0.62f, 0.50f, 0.74f },
                                       { 0.90f, 0.82f, 0.35f }, { 0.45f, 0.33f, 0.25f },
                                       { 0.93f, 0.60f, 0.70f }, { 0.40f, 0.43f, 0.46f } };
    memcpy(out, colors[(b >= 0 ? b : number)%8], sizeof colors[0]);
    for (int c = 0; b >= 0 && looks->bodies[b].color[0] >= 0 && c < 3; c++)
        out[c] = (float)(looks->bodies[b].color[c]/255);
}

static void take_bodies(tobi_drawing *d)
{
    const tobi_moment *m = d->moment;
    int count = 0;
    for (int k = 0; k < m->surface_count; k++) {
        const tobi_moment_surface *s = &m->surfaces[k];
        const int b = tobi_drawing_find_body(d->looks, s->name);
        const tobi_body_look *look = b >= 0 ? &d->looks->bodies[b] : NULL;
        if (look && !look->visible) continue;
        tobi_picture_mesh *mesh = &d->meshes[count++];
        *mesh = (tobi_picture_mesh){ .vertex_count = s->vertex_count,
                                     .vertices = (const double (*)[3])s->vertices,
                                     .triangle_count = s->triangle_count,
                                     .triangles = (const int32_t (*)[3])s->triangles,
                                     .transparency = look ? (float)(1 - look->opacity) : 0,
                                     .hollow = look && look->hollow };
        if (look && look->image && look->triangle_count == s->triangle_count)
            mesh->image = look->image, mesh->uv = (const float (*)[3][2])look->uv;
        find_color(d->looks, b, k, mesh->color);
    }
    d->picture.meshes = d->meshes;
    d->picture.mesh_count = count;
}

/* Whether a particle's value has a colour of the scale. */
static int is_scaled(const tobi_drawing *d, int64_t i)
{
    return isfinite(d->values[i]) && !(d->own && d->own[i][0] >= 0) && view_is_in_nest(&d->picture, i);
}

/* Of the values within a range. */
static void find_extremes(const tobi_drawing *d, double from, double to, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (int64_t i = 0; i < d->count; i++) {
        if (!is_scaled(d, i) || !(d->values[i] >= from && d->values[i] <= to)) continue;
        *low = fmin(*low, d->values[i]);
        *high = fmax(*high, d->values[i]);
    }
}

/* Narrows a range by strays, at most one in STRAYS of the values at each end, if it then is less than half as
   wide: a drop that hits a wall has a hundred times the pressure of the tank. Where nearly all values are one
   the others are no strays, and the range stays. */
static void leave_out_strays(const tobi_drawing *d, double *low, double *high)
{
    enum { BINS = 4096, STRAYS = 500, ROUNDS = 12 };
    double from = *low, to = *high;
    for (int round = 0; round < ROUNDS; round++) {
        int64_t count[BINS] = { 0 }, below = 0, above = 0, all = 0;
        const double width = (to - from)/BINS;
        int first = 0, last = BINS - 1;
        if (!(width > 0)) return;
        for (int64_t i = 0; i < d->count; i++) {
            if (!is_scaled(d, i)) continue;
            const double bin = (d->values[i] - from)/width;
            if (bin < 0) below++;
            else if (bin > BINS) above++;
            else count[bin < BINS ? (int)bin : BINS - 1]++;
            all++;
        }
        while (first < last && (below += count[first]) <= all/STRAYS) first++;
        while (last > first && (above += count[last]) <= all/STRAYS) last--;
        if (2*(last + 1 - first) > BINS) {
            if (round > 0) find_extremes(d, from, to, low, high);
            return;
        }
        to = from + (last + 1)*width;
        from += first*width;
    }
}

/* Range and label of the colours of a field, or of the speed. */
static void set_range(tobi_drawing *d)
{
    const char *name = d->view->field ? d->view->field : "speed";
    double low = d->view->min, high = d->view->max;
    if (!(low < high)) {
        find_extremes(d, -INFINITY, INFINITY, &low, &high);
        if (!(low <= high)) low = high = 0;
        leave_out_strays(d, &low, &high);
        const char *map = tobi_color_map_name(d->view->map);
        const int parts = low < 0 && high > 0 && map && strcmp(map, "coolwarm") == 0;     /* at its middle */
        if (parts || is_turn(d->looks, name)) high = fmax(fabs(low), fabs(high)), low = -high;
        if (low == high) high = low + fmax(1e-6*fabs(low), 1e-6);
    }
    d->picture.value_min = low;
    d->picture.value_max = high;
    tobi_field_label(name, d->label, sizeof d->label);
    d->picture.label = d->label;
}

/* The camera moves as the mean of the body's vertices has done since its rest pose. */
static void follow_body(tobi_drawing *d)
{
    for (int k = 0; k < d->moment->surface_count; k++) {
        const tobi_moment_surface *s = &d->moment->surfaces[k];
        const int b = tobi_drawing_find_body(d->looks, s->name);
        if (b < 0 || strcmp(d->looks->bodies[b].body, d->view->follow) != 0 || s->vertex_count == 0) continue;
        for (int a = 0; a < 3; a++) {
            double sum = 0;
            for (int64_t i = 0; i < s->vertex_count; i++) sum += s->vertices[i][a];
            const double way = sum/(double)s->vertex_count - d->looks->bodies[b].rest[a];
            d->picture.eye[a] += way;
            d->picture.target[a] += way;
        }
    }
}

/* In the colours of the bodies. */
static tobi_status take_paths(tobi_drawing *d, tobi_error *err)
{
    const tobi_moment *m = d->moment;
    if (!d->view->paths) return TOBI_OK;
    d->paths = calloc((size_t)m->track_count + 1, sizeof *d->paths);
    if (!d->paths) return no_memory(err);
    for (int k = 0; k < m->track_count; k++) {
        const int b = tobi_drawing_find_body(d->looks, m->tracks[k].body);
        if (b >= 0 && !d->looks->bodies[b].visible) continue;
        tobi_picture_path *path = &d->paths[d->picture.path_count++];
        *path = (tobi_picture_path){ .count = m->tracks[k].count,
                                     .points = (const double (*)[3])m->tracks[k].points };
        find_color(d->looks, b, k, path->color);
    }
    d->picture.paths = d->paths;
    return TOBI_OK;
}

/* What the view says; colours of a field. */
static void set_view(tobi_drawing *d)
{
    tobi_picture *p = &d->picture;
    tobi_picture_set_view(p, d->view);
    if (d->view->arrows) p->velocities = (const double (*)[3])d->velocities;
    if (d->view->streamlines > 0) p->flow = (const double (*)[3])d->velocities;
    if (d->view->follow && p->has_camera) follow_body(d);
    if (d->has_palette) p->isolines = 0;      /* values are numbers of colours */
    if (!d->view->field && p->look == TOBI_LOOK_NATURAL) return;
    p->palette = tobi_color_map(tobi_color_map_name(d->view->map), &p->palette_count);
    p->values = d->values;
    p->own = (const float (*)[3])d->own;
    if (p->look == TOBI_LOOK_NATURAL) p->look = TOBI_LOOK_SURFACE;
    set_range(d);
}

/* Four digits after the point, or three that count. */
static void write_time(double t, char *text, size_t room)
{
    const int lead = t > 0 ? (int)floor(log10(t)) : 0;
    if (lead < -6) snprintf(text, room, "t = %.3g s", t);
    else snprintf(text, room, "t = %.*f s", lead < -2 ? 2 - lead : 4, t);
}

static void set_picture(tobi_drawing *d)
{
    const tobi_looks *s = d->looks;
    tobi_picture *p = &d->picture;
    int solids = 0, liquids = 0;
    for (int k = 0; k < s->material_count; k++) {
        solids |= !s->materials[k].liquid;
        liquids |= s->materials[k].liquid && s->materials[k].kind > 0;
    }
    for (int a = 0; a < 3; a++)
        p->box_min[a] = s->box_min[a], p->box_max[a] = s->box_max[a], p->up[a] = -s->gravity[a];
    p->dimension = s->dimension;
    p->zones = (const double (*)[2][3])s->zones, p->zone_count = s->zone_count;
    p->edges = (const double (*)[2][3])s->edges, p->edge_count = s->edge_count;
    p->particle_count = d->count;
    p->positions = (const double (*)[3])d->positions;
    p->values = d->values;
    p->radius = 0.5*s->spacing;
    p->radii = d->radii;
    if (solids) p->opaque = d->opaque;
    if (solids || liquids || d->nest) p->group = d->group;
    p->nests = (const double (*)[2][3])d->moment->nests;
    p->nest_count = d->nest ? d->moment->nest_count : 0;
    p->nest = d->nest;
    p->value_max = d->has_palette ? d->colors - 1 : s->speed;
    if (d->has_palette) p->palette = (const float (*)[3])d->palette, p->palette_count = d->colors;
    write_time(d->moment->time, d->title, sizeof d->title);
    p->title = d->title;
    if (d->skin) {
        p->skins = d->skins, p->skin_count = s->material_count;
        p->skin = d->skin, p->rest = (const double (*)[3])d->rest;
    }
    p->threads = s->threads;
    if (d->view->foam) {
        p->foam_count = d->moment->foam_count;
        p->foam = (const double (*)[3])d->moment->foam;
        p->foam_kind = d->moment->foam_kind;
    }
    /* Water in 3-D looks like water; what else has no colour of its own shows its speed. */
    const int natural = s->dimension == 3 && !d->has_palette && !solids;
    if (natural) p->values = NULL;
    tobi_field_label("speed", d->label, sizeof d->label);
    p->label = d->has_palette || natural ? NULL : d->label;
}

static tobi_status make(tobi_drawing *d, tobi_error *err)
{
    const tobi_moment *m = d->moment;
    d->picture = tobi_default_picture();
    d->material = find_field(m, "material");
    d->part = find_field(m, "part");
    d->piece = find_field(m, "piece");
    d->at_rest = find_field(m, "rest_position");
    d->meshes = calloc((size_t)m->surface_count + 1, sizeof *d->meshes);
    if (!d->meshes) return no_memory(err);
    TOBI_TRY(tobi_drawing_make_palette(d, find_field(m, "particle_id"), err));
    TOBI_TRY(take_particles(d, err));
    set_picture(d);
    take_bodies(d);
    TOBI_TRY(view_take_zones(d, err));
    TOBI_TRY(take_paths(d, err));
    set_view(d);
    return TOBI_OK;
}

tobi_status tobi_drawing_make(const tobi_looks *looks, const tobi_moment *moment, const tobi_view_def *view,
                              tobi_drawing **drawing, tobi_error *err)
{
    TOBI_NEED(looks, "the looks");
    TOBI_NEED(moment, "the moment");
    TOBI_NEED(view, "the view");
    TOBI_NEED(drawing, "the place for the drawing");
    tobi_drawing *d = *drawing = calloc(1, sizeof *d);
    if (!d) return no_memory(err);
    d->looks = looks, d->moment = moment, d->view = view;
    const tobi_status status = make(d, err);
    if (status == TOBI_OK) return status;
    tobi_drawing_free(d);
    *drawing = NULL;
    return status;
}
