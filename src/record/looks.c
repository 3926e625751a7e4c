/* What of a world pictures need: colours and names of its materials, bodies and lines. Drawback: lists are
   copied, so that they outlive their world. */
#include "geom/vec3.h"
#include "mpm/particle_fields.h"
#include "record/record.h"
#include "world/fit.h"
#include "world/nest.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int is_same_fluid(const tobi_fluid *a, const tobi_fluid *b)
{
    return a->density == b->density && a->viscosity == b->viscosity && a->tension == b->tension &&
           a->visible == b->visible && memcmp(a->color, b->color, sizeof a->color) == 0;
}

/* Fluids that differ in nothing are one kind, which has one surface. */
static tobi_status add_materials(const tobi_world *w, const tobi_system *s, tobi_looks *looks,
                                 tobi_error *err)
{
    const int first = tobi_world_first_material(w, s);
    const double spacing = tobi_world_spacing(w, s);
    for (int k = 0; k < s->fluid_count; k++) {
        tobi_material_look *m = &looks->materials[looks->material_count++];
        *m = (tobi_material_look){ .visible = s->fluid[k].visible, .liquid = 1, .kind = first + k,
                                   .spacing = spacing };
        for (int n = k - 1; n >= 0; n--)
            if (is_same_fluid(&s->fluid[n], &s->fluid[k])) m->kind = first + n;
        memcpy(m->color, s->fluid[k].color, sizeof m->color);
        memcpy(m->core_color, s->fluid[k].color, sizeof m->core_color);
    }
    for (int k = 0; k < s->solid_count; k++) {
        const tobi_solid_def *def = &s->solids[k].def;
        tobi_material_look *m = &looks->materials[looks->material_count++];
        *m = (tobi_material_look){ .visible = def->visible, .liquid = def->model == TOBI_LIQUID,
                                   .kind = first + k, .spacing = spacing };
        memcpy(m->color, def->color, sizeof m->color);
        memcpy(m->core_color, def->core_color, sizeof m->core_color);
        TOBI_TRY(tobi_skins_of_solid(w, k, looks->material_count - 1, looks, err));
    }
    return TOBI_OK;
}

/* A vessel that has no opacity is of glass, so that pictures show the liquid in it; in 2-D its section is an
   outline. */
static void choose_surface(const tobi_body *b, int dimension, tobi_body_look *look)
{
    static const double glass[3] = { 190, 220, 225 };
    const int is_glass = b->vessel && dimension == 3 && !(b->opacity > 0);
    look->opacity = is_glass ? 0.15 : b->opacity > 0 ? b->opacity : 1;
    memcpy(look->color, is_glass && b->color[0] < 0 ? glass : b->color, sizeof look->color);
}

static tobi_status add_bodies(const tobi_world *w, const tobi_record_name *names, tobi_looks *looks,
                              tobi_error *err)
{
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        tobi_body_look *look = &looks->bodies[looks->body_count++];
        *look = (tobi_body_look){ .visible = b->visible, .hollow = b->vessel };
        choose_surface(b, looks->dimension, look);
        memcpy(look->name, names[k], sizeof look->name);
        snprintf(look->body, sizeof look->body, "%s", b->name);
        tobi_nest_middle(&w->sim, k, look->middle);
        for (int a = 0; a < 3; a++) look->middle[a] += b->lower[a];
        for (int64_t i = 0; i < b->mesh.vertex_count; i++)
            for (int a = 0; a < 3; a++)
                look->rest[a] += b->mesh.vertices[i][a]/(double)b->mesh.vertex_count;
        TOBI_TRY(tobi_skins_of_body(w, k, look, err));
    }
    return TOBI_OK;
}

static void add_lines(const tobi_world *w, const tobi_record_name *names, tobi_looks *looks)
{
    for (int k = 0; k < w->line_count; k++) {
        tobi_body_look *look = &looks->bodies[looks->body_count++];
        *look = (tobi_body_look){ .color = { 38, 38, 41 }, .opacity = 1, .visible = 1, .is_line = 1 };
        memcpy(look->name, names[k], sizeof look->name);
    }
}

/* When it flows: between two rows of a table if one of them does, before and after all as the end row. */
static void find_flows(const tobi_opening *o, tobi_inlet_look *in)
{
    if (!o->rows) {
        in->flows[in->flow_count][0] = o->start;
        in->flows[in->flow_count++][1] = o->stop > 0 ? o->stop : INFINITY;
        return;
    }
    for (int64_t k = -1; k < o->row_count; k++) {
        const bool first = k < 0, last = k + 1 == o->row_count;
        const double low = first ? 0 : o->rows[k].speed, high = last ? 0 : o->rows[k + 1].speed;
        if (!(low > 0 || high > 0)) continue;
        const double from = first ? -INFINITY : o->rows[k].time, to = last ? INFINITY : o->rows[k + 1].time;
        if (in->flow_count > 0 && in->flows[in->flow_count - 1][1] == from) {
            in->flows[in->flow_count - 1][1] = to;
            continue;
        }
        in->flows[in->flow_count][0] = from;
        in->flows[in->flow_count++][1] = to;
    }
}

static tobi_status add_inlets(const tobi_world *w, tobi_looks *looks, tobi_error *err)
{
    looks->inlets = calloc((size_t)w->sim.opening_count + 1, sizeof *looks->inlets);
    if (!looks->inlets) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    for (int k = 0; k < w->sim.opening_count; k++) {
        const tobi_opening *o = &w->sim.openings[k];
        if (o->outlet) continue;
        tobi_inlet_look *in = &looks->inlets[looks->inlet_count++];
        *in = (tobi_inlet_look){ .half = { o->half[0], o->half[1] }, .radius = o->radius,
                                 .depth = o->depth + o->step };
        for (int a = 0; a < 3; a++) {
            in->centre[a] = o->centre[a] + w->system[0].box.lower[a];
            in->normal[a] = o->normal[a], in->along[a] = o->along[a], in->across[a] = o->across[a];
        }
        in->flows = malloc(((size_t)o->row_count + 2)*sizeof *in->flows);
        if (!in->flows) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
        find_flows(o, in);
    }
    return TOBI_OK;
}

/* The part of a line within the domain, if any. */
static void add_edge(tobi_looks *looks, const double a[3], const double b[3])
{
    double part[2] = { 0, 1 };
    for (int n = 0; n < looks->dimension; n++) {
        const double way = b[n] - a[n], low = looks->box_min[n] - a[n], high = looks->box_max[n] - a[n];
        if (way == 0 && (low > 0 || high < 0)) return;
        if (way == 0) continue;
        part[0] = fmax(part[0], fmin(low/way, high/way));
        part[1] = fmin(part[1], fmax(low/way, high/way));
    }
    if (!(part[1] > part[0])) return;
    double (*edge)[3] = looks->edges[looks->edge_count++];
    for (int end = 0; end < 2; end++)
        for (int n = 0; n < 3; n++) edge[end][n] = a[n] + part[end]*(b[n] - a[n]);
}

/* Three vertices of the surface, far apart, and where they start. */
static void find_anchors(const tobi_body *b, const tobi_porous *z, int dimension, tobi_body_look *look)
{
    const double (*rest)[3] = (const double (*)[3])b->mesh.vertices;
    double far[2] = { 0, 0 };
    for (int round = 0; round < 2; round++)
        for (int64_t i = 0; i < b->mesh.vertex_count; i++) {
            double way[3], along[3], across[3];
            vec3_sub(way, rest[i], rest[0]);
            vec3_sub(along, rest[look->anchor[1]], rest[0]);
            if (dimension == 2) way[2] = along[2] = 0;
            vec3_cross(across, along, way);
            const double size = round == 0 ? vec3_dot(way, way) : vec3_dot(across, across);
            if (size > far[round]) far[round] = size, look->anchor[1 + round] = i;
        }
    for (int k = 0; k < 3; k++) {
        double arm[3];
        vec3_sub(arm, rest[look->anchor[k]], b->rest.centre);
        for (int a = 0; a < 3; a++) {
            look->anchor_start[k][a] = b->lower[a] + z->pose.start[a] - z->pose.arm[a];
            for (int n = 0; n < 3; n++) look->anchor_start[k][a] += arm[n]*z->pose.frame[n][a];
        }
    }
}

static void add_zone_edge(const tobi_porous *z, tobi_looks *looks, const double a[3], const double b[3])
{
    if (!z->carrier) {
        add_edge(looks, a, b);
        return;
    }
    tobi_zone_edge *e = &looks->carried[looks->carried_count++];
    memcpy(e->end[0], a, sizeof e->end[0]);
    memcpy(e->end[1], b, sizeof e->end[1]);
    e->body = z->carrier - 1;
}

/* A box that a body carries, which may be turned. */
static void add_box(const tobi_porous *z, const double from[3], tobi_looks *looks)
{
    for (int k = 0; k < 1 << looks->dimension; k++)
        for (int a = 0; a < looks->dimension; a++) {
            double at[2][3] = { { 0 } };
            if (k >> a & 1) continue;
            for (int n = 0; n < 2; n++)
                for (int c = 0; c < looks->dimension; c++)
                    at[n][c] = from[c] + ((k | n << a) >> c & 1 ? z->upper : z->lower)[c];
            add_zone_edge(z, looks, at[0], at[1]);
        }
}

/* Its outline, in 3-D at both ends with the edges between them. */
static void add_prism(const tobi_porous *z, const double from[3], tobi_looks *looks)
{
    for (int64_t k = 0; k < z->corner_count; k++) {
        const int64_t turn = z->radius > 0 ? k%(TOBI_POROUS_FACETS + 1) : 0;
        if (turn == TOBI_POROUS_FACETS) continue;        /* from the outer circle to the inner one */
        double at[2][2][3] = { 0 };       /* of both ends of the extrusion, of this corner and the next */
        for (int end = 0; end < 2; end++)
            for (int n = 0; n < 2; n++) {
                const double *corner = z->corners[(k + n)%z->corner_count];
                for (int a = 0; a < 2; a++) at[end][n][z->plane[a]] = from[z->plane[a]] + corner[a];
                if (looks->dimension == 3)
                    at[end][n][z->axis] = from[z->axis] + (end ? z->upper : z->lower)[z->axis];
            }
        add_zone_edge(z, looks, at[0][0], at[0][1]);
        if (looks->dimension == 2) continue;
        add_zone_edge(z, looks, at[1][0], at[1][1]);
        if (turn%(TOBI_POROUS_FACETS/4) == 0) add_zone_edge(z, looks, at[0][0], at[1][0]);
    }
}

static tobi_status add_zones(const tobi_world *w, tobi_looks *looks, tobi_error *err)
{
    const double *from = w->system[0].box.lower;
    int64_t corners = 0;
    for (int k = 0; k < w->sim.porous_count; k++) corners += w->sim.porous[k].corner_count;
    looks->zones = calloc((size_t)w->sim.porous_count + 1, sizeof *looks->zones);
    looks->edges = calloc((size_t)(3*corners) + 1, sizeof *looks->edges);
    looks->carried = calloc((size_t)(3*corners) + 12*(size_t)w->sim.porous_count + 1, sizeof *looks->carried);
    if (!looks->zones || !looks->edges || !looks->carried)
        return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    for (int k = 0; k < w->sim.porous_count; k++) {
        const tobi_porous *z = &w->sim.porous[k];
        const int box = !z->corners && !z->carrier;
        if (z->carrier)
            find_anchors(&w->sim.bodies[z->carrier - 1], z, looks->dimension, &looks->bodies[z->carrier - 1]);
        if (z->corners) add_prism(z, from, looks);
        else if (z->carrier) add_box(z, from, looks);
        for (int a = 0; a < looks->dimension && box; a++) {
            looks->zones[looks->zone_count][0][a] = fmax(from[a] + z->lower[a], looks->box_min[a]);
            looks->zones[looks->zone_count][1][a] = fmin(from[a] + z->upper[a], looks->box_max[a]);
        }
        looks->zone_count += box;
    }
    return TOBI_OK;
}

tobi_status tobi_world_looks(const tobi_world *w, tobi_looks *looks, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(looks, "the place for the looks");
    const tobi_world_def *def = &w->sim.def;
    const size_t materials = (size_t)tobi_world_first_material(w, w->system + w->system_count);
    tobi_record_name *body, *traction, *line;
    *looks = (tobi_looks){ .dimension = def->dimension, .threads = w->sim.exec.threads };
    /* A nest has the colours of the world around it. */
    TOBI_TRY(tobi_world_expected_speed(w->outer ? w->outer : w, &looks->speed, err));
    for (int k = 0; k < w->system_count; k++)
        looks->spacing = fmax(looks->spacing, tobi_world_spacing(w, &w->system[k]));
    looks->rim = tobi_nest_rim(&w->system[0]);
    for (int a = 0; a < 3; a++) {
        looks->box_min[a] = def->domain_min[a], looks->box_max[a] = def->domain_max[a];
        looks->gravity[a] = def->gravity[a];
    }
    looks->materials = calloc(materials + 1, sizeof *looks->materials);
    looks->bodies = calloc((size_t)(w->sim.body_count + w->line_count) + 1, sizeof *looks->bodies);
    tobi_status status = tobi_record_name_bodies(w, &body, &traction, &line, err);
    if (status == TOBI_OK && (!looks->materials || !looks->bodies))
        status = tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    for (int k = 0; status == TOBI_OK && k < w->system_count; k++)
        status = add_materials(w, &w->system[k], looks, err);
    if (status == TOBI_OK) status = add_bodies(w, body, looks, err);
    if (status == TOBI_OK) status = add_inlets(w, looks, err);
    if (status == TOBI_OK) status = add_zones(w, looks, err);
    if (status == TOBI_OK) add_lines(w, line, looks);
    else tobi_looks_free(looks);
    free(body);
    free(traction);
    free(line);
    return status;
}

bool tobi_record_has_pieces(const tobi_world *w)
{
    const tobi_system *s = tobi_world_solids(w);
    bool blades = false, breaks = false;
    const mpm_fields *fields = s ? mpm_fields_of(&s->particles) : NULL;
    blades = fields && fields->cuts;          /* before the start there are none */
    for (int k = 0; k < w->sim.body_count; k++) blades |= w->sim.bodies[k].blade;
    for (int k = 0; s && k < s->solid_count; k++) {
        const tobi_solid_def *def = &s->solids[k].def;
        breaks |= tobi_solid_uses(def->model, "cut_friction") && (blades || def->strength > 0);
    }
    return breaks;
}

bool tobi_record_has_kinds(const tobi_world *w)
{
    const tobi_system *s = tobi_world_fluids(w);
    bool differ = false;
    for (int k = 1; s && k < s->fluid_count; k++) differ |= !is_same_fluid(&s->fluid[0], &s->fluid[k]);
    return differ;
}

/* Once for a run. */
tobi_status tobi_record_find_looks(tobi_run *run, tobi_error *err)
{
    return run->looks.spacing > 0 ? TOBI_OK : tobi_world_looks(run->world, &run->looks, err);
}
