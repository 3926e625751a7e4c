/* The picture of an output: water coloured by speed and bodies by number unless they have colours of their
   own, seen so that the box fits unless there is a camera. */
#include "mpm/cuts.h"
#include "mpm/particle_fields.h"
#include "tobiuo/picture.h"
#include "base/param.h"
#include "record/line_tube.h"
#include "record/record.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const float body_colors[][3] = {
    { 0.93f, 0.62f, 0.28f }, { 0.80f, 0.33f, 0.36f }, { 0.55f, 0.70f, 0.35f }, { 0.62f, 0.50f, 0.74f },
};
enum { COLOR_COUNT = sizeof body_colors / sizeof *body_colors };

typedef struct tobi_drawing {
    tobi_picture frame;                  /* of what follows                               */
    char title[64], label[96];
    double (*velocities)[3];           /* n, or NULL: no arrows                         */
    double *positions;                 /* n x 3                                         */
    float *values;                     /* n, speeds; with a palette the colour's number */
    int64_t count;                     /* particles that are shown                      */
    float (*palette)[3];
    int colors;                        /* in the palette                                */
    int has_palette;                   /* 0: colours by speed                           */
    uint8_t *tint;                     /* of each piece, or NULL: nothing can part      */
    uint8_t *opaque;                   /* n, or NULL: all are liquid                    */
    int32_t *group;                    /* n, with opaque: material or piece             */
    int mesh_count;
    tobi_picture_mesh *meshes;
    tobi_line_tube *tubes;             /* of the lines                                  */
    const tobi_record_view *view;      /* of the run                                    */
} tobi_drawing;

void tobi_drawing_free(tobi_drawing *d)
{
    if (!d) return;
    free(d->positions);
    free(d->velocities);
    free(d->values);
    free(d->palette);
    free(d->tint);
    free(d->opaque);
    free(d->group);
    free(d->meshes);
    free(d->tubes);
    free(d);
}

/* A view and what it names; key: of the scene, for messages. */
static tobi_status add_view(tobi_run *run, const tobi_view_def *def, const char *key, tobi_error *err)
{
    tobi_record_view *view = &run->view[run->view_count++];
    char name[64];
    *view = (tobi_record_view){ .def = *def, .follow = -1 };
    snprintf(view->name, sizeof view->name, "%s", def->name ? def->name : "frame");
    snprintf(name, sizeof name, "%s.picture.field", key);
    if (def->field)
        TOBI_TRY(tobi_record_find_field(run, name, def->field, strlen(def->field), &view->field, err));
    if (!def->follow) return TOBI_OK;
    view->follow = tobi_world_find_body(run->world, def->follow);
    return view->follow >= 0 ? TOBI_OK
        : tobi_fail(err, TOBI_INVALID, "%s.picture.follow: there is no body '%s'", key, def->follow);
}

tobi_status tobi_drawing_prepare(tobi_run *run, tobi_error *err)
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

/* The value of each particle: the length of a vector. */
static tobi_status read_values(tobi_run *run, const char *name, int components, tobi_drawing *d,
                               int64_t count,
                               tobi_error *err)
{
    const size_t n = (size_t)count*(size_t)components;
    double *field = malloc(n*sizeof *field + 1);
    tobi_status status = field ? tobi_world_read(run->world, TOBI_FLUID, name, field, count, err)
        : tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    for (int64_t i = 0; status == TOBI_OK && i < count; i++) {
        double square = 0;
        for (int k = 0; k < components; k++) square += field[i*components + k]*field[i*components + k];
        d->values[i] = (float)(components > 1 ? sqrt(square) : field[i]);
    }
    free(field);
    return status;
}

/* The positions are copied, because those of hidden materials are left out. */
static tobi_status read_fluid(tobi_run *run, const tobi_point_set *fluid, tobi_drawing *d, tobi_error *err)
{
    const size_t n = (size_t)fluid->count;
    const tobi_record_field *field = &d->view->field;
    d->positions = malloc(n * 3 * sizeof *d->positions + 1);
    d->values = malloc(n * sizeof *d->values + 1);
    if (d->view->def.arrows) d->velocities = malloc(n * sizeof *d->velocities + 1);
    if (!d->positions || !d->values || (d->view->def.arrows && !d->velocities))
        return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    d->count = fluid->count;
    memcpy(d->positions, fluid->position, n * 3 * sizeof *d->positions);
    if (d->velocities)
        TOBI_TRY(tobi_world_read(run->world, TOBI_FLUID, "velocity", &d->velocities[0][0], fluid->count,
                                 err));
    return read_values(run, field->name ? field->name : "velocity", field->name ? field->components : 3, d,
                       fluid->count, err);
}

/* A fluid or solid as pictures see it. */
typedef struct material { const double *color, *core; int visible, liquid; } material;

/* By its number among those of all systems. */
static material material_at(const tobi_world *w, int m)
{
    const tobi_system *s = w->system;
    while (m >= tobi_world_first_material(w, s + 1)) s++;
    m -= tobi_world_first_material(w, s);
    if (!s->solid_count)
        return (material){ s->fluid[m].color, s->fluid[m].color, s->fluid[m].visible, 1 };
    const tobi_solid_def *def = &s->solids[m].def;
    const double *core = def->core_color[0] < 0 ? def->color : def->core_color;
    return (material){ def->color, core, def->visible, def->model == TOBI_LIQUID };
}

static void set_color(const double *color, int liquid, float out[3])
{
    static const float plain[2][3] = { { 0.04f, 0.36f, 0.70f }, { 0.10f, 0.40f, 0.50f } };
    for (int k = 0; k < 3; k++) out[k] = color[0] < 0 ? plain[liquid != 0][k] : (float)(color[k] / 255.0);
}

/* Where a particle of a material is: at its surface, below it, at the face of a cut. */
enum { SKIN, CORE, FACE, PARTS };

/* The second piece of a solid and all after it are mixed with one of these, so that halves which lie face to
   face can be told apart. */
static const float tints[][3] = {
    { 0.10f, 0.30f, 0.90f }, { 0.95f, 0.75f, 0.05f }, { 0.10f, 0.65f, 0.30f }, { 0.55f, 0.15f, 0.75f },
    { 0.95f, 0.45f, 0.05f }, { 0.05f, 0.65f, 0.75f },
};
enum { TINTS = 1 + sizeof tints / sizeof *tints };

static void mix(float color[3], const float with[3], float share)
{
    for (int k = 0; k < 3; k++) color[k] += share * (with[k] - color[k]);
}

/* Without a core of its own, a cut face is paler than its material, or darker where that is pale. */
static void find_color(const material *look, int part, int tint, float out[3])
{
    static const float white[3] = { 1, 1, 1 }, black[3] = { 0, 0, 0 };
    set_color(part == SKIN ? look->color : look->core, look->liquid, out);
    const int pale = out[0] + out[1] + out[2] > 2;
    if (part == FACE && look->core == look->color) mix(out, pale ? black : white, 0.4f);
    if (tint > 0) mix(out, tints[tint - 1], 0.3f);
}

/* Whether a blade or a crack may part a solid of the world. */
static int can_part(const tobi_system *s, int solid)
{
    const tobi_solid_def *def = &s->solids[solid].def;
    return tobi_solid_uses(def->model, "cut_friction") &&
           (mpm_fields_of(&s->particles)->cuts || def->strength > 0);
}

/* The palette, if any material has a colour: of each material skin, core and face, each in all tints. */
static tobi_status make_palette(const tobi_world *w, int materials, tobi_drawing *d, tobi_error *err)
{
    d->colors = materials * PARTS * TINTS;
    d->palette = malloc(((size_t)d->colors + 1) * sizeof *d->palette);
    if (!d->palette) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    for (int c = 0; c < d->colors; c++) {
        const material look = material_at(w, c / (PARTS * TINTS));
        d->has_palette |= look.core[0] >= 0;
        find_color(&look, c % PARTS, c / PARTS % TINTS, d->palette[c]);
    }
    return TOBI_OK;
}

static int order_pieces(const void *a, const void *b)
{
    const tobi_piece *p = *(const tobi_piece *const *)a, *q = *(const tobi_piece *const *)b;
    if (p->solid != q->solid) return p->solid < q->solid ? -1 : 1;
    return p->first_id < q->first_id ? -1 : p->first_id > q->first_id;
}

/* The tint of each piece, by its first particle, so that it keeps it as long as there are few: the first
   piece of a solid has none, nor has debris. */
static tobi_status choose_tints(tobi_run *run, tobi_drawing *d, tobi_error *err)
{
    const tobi_pieces *found;
    int any = 0, taken[TINTS] = { 0 };
    const tobi_system *s = tobi_world_solids(run->world);
    for (int k = 0; s && k < s->solid_count; k++) any |= can_part(s, k);
    if (!any || !d->has_palette) return TOBI_OK;
    TOBI_TRY(tobi_world_pieces(run->world, &found, err));
    d->tint = calloc((size_t)(found->count + found->fragments) + 1, sizeof *d->tint);
    const tobi_piece **order = malloc(((size_t)found->count + 1) * sizeof *order);
    for (int64_t k = 0; order && k < found->count; k++) order[k] = &found->piece[k];
    if (order) qsort(order, (size_t)found->count, sizeof *order, order_pieces);
    for (int64_t k = 0; d->tint && order && k < found->count; k++) {
        const tobi_piece *p = order[k];
        const int first = k == 0 || p->solid != order[k - 1]->solid;
        if (first) memset(taken, 0, sizeof taken);
        if (first || !can_part(s, p->solid)) continue;
        int tint = 1 + (int)((uint64_t)p->first_id * 0x9e3779b97f4a7c15u >> 33) % (TINTS - 1);
        for (int n = 0; n < TINTS && taken[tint]; n++) tint = tint % (TINTS - 1) + 1;
        taken[tint] = 1;
        d->tint[p - found->piece] = (uint8_t)tint;
    }
    free(order);
    return d->tint && order ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
}

/* At a cut: within a spacing, so that each of its sides has a layer. */
static int find_part(const tobi_system *s, int64_t row)
{
    if (!s->method->solids) return SKIN;
    const mpm_fields *f = mpm_fields_of(&s->particles);
    for (int k = 0; f->cuts && k < TOBI_CUTS_EACH && f->cuts[row].c[k].w != 0; k++) {
        const tobi_float4 *way = &f->cuts[row].c[k];
        const double square = (double)way->x * way->x + (double)way->y * way->y + (double)way->z * way->z;
        if (square < s->smoothing.spacing * s->smoothing.spacing) return FACE;
    }
    return f->rest[row].w > 0 ? CORE : SKIN;
}

/* The particles of a system, which begin at *from, to those that are shown, of which there are d->count. */
static void color_system(const tobi_world *w, const tobi_system *s, int64_t *from, tobi_drawing *d)
{
    const int pieces = d->tint && s->solid_count > 0;
    for (int64_t n = 0; n < s->particles.count; n++) {
        const int64_t i = (*from)++, to = d->count, row = s->row_of[n];      /* rows are fresh: just read */
        const int m = tobi_world_first_material(w, s) + s->particles.fluid[row];
        const int piece = pieces ? w->pieces.of[row] : -1;
        const material look = material_at(w, m);
        if (!look.visible) continue;
        memmove(d->positions + 3 * to, d->positions + 3 * i, 3 * sizeof *d->positions);
        if (d->velocities) memmove(d->velocities[to], d->velocities[i], sizeof d->velocities[to]);
        if (d->opaque) d->opaque[to] = !look.liquid;
        if (d->group) d->group[to] = piece >= 0 ? 1 + piece : -m;
        /* In 3-D the pieces have surfaces of their own. */
        const int tint = piece >= 0 && w->sim.def.dimension == 2 ? d->tint[piece] : 0;
        const int color = (m * TINTS + tint) * PARTS + find_part(s, row);
        d->values[to] = d->has_palette ? (float)color : d->values[i];
        d->count++;
    }
}

/* Materials with colours: the value becomes the colour's number; hidden materials are left out. */
static tobi_status color_materials(tobi_run *run, tobi_drawing *d, tobi_error *err)
{
    const tobi_world *w = run->world;
    const int materials = tobi_world_first_material(w, w->system + w->system_count);
    int hidden = 0, solids = 0;
    TOBI_TRY(make_palette(w, materials, d, err));
    if (d->view->field.name || d->view->def.look) d->has_palette = 0;
    TOBI_TRY(choose_tints(run, d, err));
    for (int m = 0; m < materials; m++) {
        const material look = material_at(w, m);
        hidden |= !look.visible;
        solids |= !look.liquid;
    }
    if (!hidden && !d->has_palette && !solids) return TOBI_OK;
    if (solids) d->opaque = malloc((size_t)d->count + 1);
    if (solids) d->group = malloc(((size_t)d->count + 1)*sizeof *d->group);
    if (solids && (!d->opaque || !d->group)) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    int64_t from = 0;
    d->count = 0;
    for (int k = 0; k < w->system_count; k++) color_system(w, &w->system[k], &from, d);
    return TOBI_OK;
}

static tobi_status list_meshes(const tobi_run *run, const tobi_snapshot *snapshot, tobi_drawing *d,
                               tobi_error *err)
{
    const int lines = tobi_world_line_count(run->world);
    d->meshes = calloc((size_t)(snapshot->surfaces + lines) + 1, sizeof *d->meshes);
    d->tubes = malloc((size_t)lines*sizeof *d->tubes + 1);
    if (!d->meshes || !d->tubes) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    for (int b = 0; b < snapshot->surfaces; b++) {
        const tobi_body *body = &run->world->sim.bodies[b];
        if (!body->visible || !snapshot->surface[b]) continue;
        tobi_picture_mesh *m = &d->meshes[d->mesh_count++];
        *m = (tobi_picture_mesh){ .vertex_count = body->mesh.vertex_count,
                                .vertices = (const double (*)[3])snapshot->surface[b],
                                .triangle_count = body->mesh.triangle_count,
                                .triangles = (const int32_t (*)[3])body->mesh.triangles };
        memcpy(m->color, body_colors[b % COLOR_COUNT], sizeof m->color);
        for (int k = 0; k < 3 && body->color[0] >= 0; k++) m->color[k] = (float)(body->color[k] / 255.0);
        m->transparency = (float)(1 - body->opacity);
        m->hollow = body->vessel;
    }
    for (int k = 0; k < lines; k++)
        d->meshes[d->mesh_count++] = tobi_line_draw(&run->world->lines[k],
                                                    0.15*run->world->sim.def.spacing, &d->tubes[k]);
    return TOBI_OK;
}

/* Half the speed of a fall through the domain: the same colours in every picture of a run. */
static double color_speed(const tobi_world_def *def)
{
    double work = 0.0;
    for (int a = 0; a < def->dimension; a++)
        work += fabs(def->gravity[a]) * (def->domain_max[a] - def->domain_min[a]);
    return 0.5 * sqrt(2.0 * work);
}

/* Range and label of the colours of a field, or of the speed. */
static void set_range(tobi_drawing *d)
{
    const char *name = d->view->field.name ? d->view->field.name : "speed", *known, *unit = "m/s";
    double low = d->view->def.min, high = d->view->def.max;
    int components;
    if (!(low < high)) {
        low = INFINITY, high = -INFINITY;
        for (int64_t i = 0; i < d->count; i++) {
            if (!isfinite(d->values[i])) continue;
            low = fmin(low, d->values[i]);
            high = fmax(high, d->values[i]);
        }
        if (!(low <= high)) low = high = 0;
        if (low == high) high = low + fmax(1e-6*fabs(low), 1e-6);
    }
    d->frame.value_min = low;
    d->frame.value_max = high;
    for (int k = 0; d->view->field.name && (known = tobi_world_field_name(k, &components, &unit)); k++)
        if (strcmp(known, name) == 0) break;
    const int bare = !unit || strcmp(unit, "1") == 0;
    snprintf(d->label, sizeof d->label, bare ? "%s" : "%s [%s]", name, unit);
    d->frame.label = d->label;
}

/* The camera moves as the mean of the body's vertices has done since its rest pose. */
static void follow_body(const tobi_run *run, const tobi_snapshot *snapshot, int body, tobi_picture *frame)
{
    const tobi_mesh *mesh = &run->world->sim.bodies[body].mesh;
    const double (*now)[3] = (const double (*)[3])snapshot->surface[body];
    if (!now) return;                    /* it is absent */
    for (int k = 0; k < 3; k++) {
        double way = 0;
        for (int64_t i = 0; i < mesh->vertex_count; i++) way += now[i][k] - mesh->vertices[i][k];
        way /= (double)(mesh->vertex_count > 0 ? mesh->vertex_count : 1);
        frame->eye[k] += way;
        frame->target[k] += way;
    }
}

/* What the view says; colours of a field. */
static void set_picture(const tobi_run *run, const tobi_snapshot *snapshot, tobi_drawing *d)
{
    const tobi_view_def *v = &d->view->def;
    tobi_picture *frame = &d->frame;
    tobi_picture_set_view(frame, v);
    frame->velocities = (const double (*)[3])d->velocities;
    if (d->view->follow >= 0 && frame->has_camera) follow_body(run, snapshot, d->view->follow, frame);
    if (d->view->field.name || frame->look != TOBI_LOOK_NATURAL) {
        frame->palette = tobi_color_map(tobi_color_map_name(v->map), &frame->palette_count);
        frame->values = d->values;
        if (frame->look == TOBI_LOOK_NATURAL) frame->look = TOBI_LOOK_SURFACE;
        set_range(d);
    }
}

static void set_frame(const tobi_run *run, const tobi_snapshot *snapshot, tobi_drawing *d)
{
    const tobi_world_def *def = &run->world->sim.def;
    tobi_picture *frame = &d->frame;
    *frame = tobi_default_picture();
    frame->dimension = def->dimension;
    for (int a = 0; a < 3; a++) {
        frame->box_min[a] = def->domain_min[a];
        frame->box_max[a] = def->domain_max[a];
        frame->up[a] = -def->gravity[a];
    }
    frame->particle_count = d->count;
    frame->mesh_count = d->mesh_count;
    frame->positions = (const double (*)[3])(void *)d->positions;
    frame->values = d->values;
    frame->radius = 0.5 * def->spacing;
    frame->opaque = d->opaque;
    frame->group = d->group;
    frame->value_max = d->has_palette ? d->colors - 1 : color_speed(def);
    if (d->has_palette) {
        frame->palette = (const float (*)[3])d->palette;
        frame->palette_count = d->colors;
    }
    frame->meshes = d->meshes;
    snprintf(d->title, sizeof d->title, "t = %.4f s", tobi_world_time(run->world));
    frame->title = d->title;
    frame->threads = run->world->sim.exec.threads;
    /* Water in 3-D looks like water; what else has no colour of its own shows its speed. */
    const int natural = def->dimension == 3 && !d->has_palette && !d->opaque;
    if (natural) frame->values = NULL;
    frame->label = d->has_palette || natural ? NULL : "speed [m/s]";
    set_picture(run, snapshot, d);
}

static tobi_status take_view(tobi_run *run, tobi_snapshot *snapshot, int k, tobi_error *err)
{
    tobi_drawing *d = snapshot->drawing[k] = calloc(1, sizeof *d);
    if (!d) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    d->view = &run->view[k];
    TOBI_TRY(read_fluid(run, &snapshot->set[TOBI_SET_FLUID], d, err));
    TOBI_TRY(color_materials(run, d, err));
    TOBI_TRY(list_meshes(run, snapshot, d, err));
    set_frame(run, snapshot, d);
    return TOBI_OK;
}

tobi_status tobi_drawing_take(tobi_run *run, tobi_snapshot *snapshot, tobi_error *err)
{
    for (int k = 0; k < run->view_count; k++) TOBI_TRY(take_view(run, snapshot, k, err));
    return TOBI_OK;
}

static tobi_status write_view(tobi_run *run, const tobi_snapshot *snapshot, int k, tobi_error *err)
{
    const double begun = tobi_record_clock();
    char *path = tobi_record_path(run->dir, "frames/%s_%06lld.png", run->view[k].name,
                                  (long long)snapshot->number);
    tobi_status status = path ? tobi_picture_write(path, &snapshot->drawing[k]->frame, err)
                              : tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    free(path);
    if (status == TOBI_OK) {
        __atomic_fetch_add(&run->picture_ns, (int64_t)(1e9*(tobi_record_clock() - begun)), __ATOMIC_RELAXED);
        __atomic_fetch_add(&run->pictures, 1, __ATOMIC_RELAXED);
    }
    return status;
}

tobi_status tobi_drawing_write(tobi_run *run, const tobi_snapshot *snapshot, tobi_error *err)
{
    for (int k = 0; k < run->view_count; k++) TOBI_TRY(write_view(run, snapshot, k, err));
    return TOBI_OK;
}

int64_t tobi_run_pictures(const tobi_run *run, double *seconds)
{
    if (seconds) *seconds = 1e-9*(double)__atomic_load_n(&run->picture_ns, __ATOMIC_RELAXED);
    return __atomic_load_n(&run->pictures, __ATOMIC_RELAXED);
}
