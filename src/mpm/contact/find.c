/* Which particles a body touches. Looking at the mesh is dear, so every body has a list of the particles that
   may come near it, and each of them a distance that it certainly keeps: no particle is looked at before it
   and the body may have used that up. The contacts are the same as those of looking at all in every step. */
#include "mpm/contact/contact.h"
#include "base/error.h"
#include "mpm/cut/cuts.h"
#include "mpm/particle_fields.h"
#include "geom/vec3.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double IDLE = 0.02;

/* fmax is a call. */
static double larger(double a, double b) { return a > b ? a : b; }
static double smaller(double a, double b) { return a < b ? a : b; }

/* Less `way` of its list, clear is what the particle is at least outside the surface, m. Until that way is
   `sure`, the triangle of this slot of the tree is nearest to it and no other as near. */
typedef struct candidate { int32_t particle, slot; float clear, sure; } candidate;

/* Particles near one body. */
struct tobi_contact_candidates {
    const tobi_body *body;
    candidate *list;                 /* in rising order                                          */
    int64_t count, room;
    double position[3], orientation[4];  /* of the body when last looked at                      */
    double drift;                    /* m, of the particles then                                 */
    double way;                      /* m, by which body and particles may have come nearer since
                                        the list was made                                        */
};

/* Contacts, or candidates, that one block of particles or candidates has. */
struct tobi_contact_run { int64_t block, count; };

void tobi_contact_free(tobi_contacts *c)
{
    for (int k = 0; k < c->candidates_room; k++) free(c->candidates[k].list);
    free(c->candidates);
    free(c->list);
    free(c->run);
    free(c->first);
    free(c->chunk_box);
    free(c->partial);
    free(c->shift);
    memset(c, 0, sizeof *c);
}

static int64_t count_chunks(int64_t n) { return (n + TOBI_BLOCK - 1)/TOBI_BLOCK; }

typedef struct boxing { tobi_contacts *c; const tobi_particles *p; } boxing;

/* The boxes around the particles of each chunk. */
static void box_chunks(const void *view, int64_t begin, int64_t end)
{
    const boxing *v = view;
    const tobi_particles *p = v->p;
    for (int64_t k = begin; k < end; k++) {
        double *box = v->c->chunk_box[k];
        for (int a = 0; a < 3; a++) { box[a] = INFINITY; box[3 + a] = -INFINITY; }
        for (int64_t i = k*TOBI_BLOCK; i < (k + 1)*TOBI_BLOCK && i < p->count; i++)
            for (int a = 0; a < 3; a++) {
                double x = (&p->position[i].x)[a];
                if (x < box[a]) box[a] = x;
                if (x > box[3 + a]) box[3 + a] = x;
            }
    }
}

static tobi_status fail_memory(int64_t contacts, tobi_error *err)
{
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for contacts of %lld particles", (long long)contacts);
}

tobi_status tobi_contact_begin(tobi_contacts *c, const tobi_particles *p, double drift, tobi_exec *x,
                               tobi_error *err)
{
    int64_t chunks = count_chunks(p->count);
    c->shift_count = 0;
    c->drift = drift;
    c->candidates_next = 0;
    for (int k = 0; k < c->candidates_room && c->marked; k++) c->candidates[k].body = NULL;
    c->marked = 0;
    if (drift > 0 && chunks <= c->chunk_room) return TOBI_OK;
    if (chunks > c->chunk_room) {
        free(c->run);
        free(c->first);
        free(c->chunk_box);
        c->run = malloc((size_t)chunks*sizeof *c->run);
        c->first = malloc((size_t)chunks*sizeof *c->first);
        c->chunk_box = malloc((size_t)chunks*sizeof *c->chunk_box);
        c->chunk_room = c->run && c->first && c->chunk_box ? chunks : 0;
        if (!c->chunk_room) return fail_memory(p->count, err);
    }
    for (int k = 0; k < c->candidates_room; k++) c->candidates[k].body = NULL;
    const boxing view = {c, p};
    tobi_loop(tobi_team(x, p->count, 32768), chunks, 0, box_chunks, &view);
    return TOBI_OK;
}

/* Where the body is, for one search. */
typedef struct pose {
    const tobi_body *body;
    const tobi_contact_step *step;
    double matrix[3][3];             /* rest axes to world axes */
    double box[2][3];                /* m, corners of the mesh: in rest axes about the centre, or of a body
                                        that bends in world axes */
    double reach;                    /* m, who is farther outside has no contact */
    int plain;                       /* 1: a blade with one edge that has a direction of its own */
} pose;

static void find_pose(const tobi_body *b, const tobi_contact_step *step, pose *at)
{
    at->body = b;
    at->step = step;
    at->plain = b->blade && b->edge_count == 1 && vec3_dot(b->edge->ahead, b->edge->ahead) > 0;
    at->reach = (b->blade ? 2 : 1)*step->radius + step->margin;
    tobi_quaternion_matrix(b->rigid.orientation, at->matrix);
    tobi_bvh_box(b->deforms ? b->bvh : b->rest_bvh, at->box[0], at->box[1]);
}

/* The box around the body in world axes, grown by `more`. */
static void find_box(const pose *at, double more, double low[3], double high[3])
{
    const tobi_body *b = at->body;
    for (int a = 0; a < 3; a++) {
        double middle = b->rigid.position[a], half = 0;
        for (int k = 0; k < 3; k++) {
            middle += 0.5*at->matrix[a][k]*(at->box[0][k] + at->box[1][k]);
            half += 0.5*fabs(at->matrix[a][k])*(at->box[1][k] - at->box[0][k]);
        }
        low[a] = (b->deforms ? at->box[0][a] : middle - half) - more;
        high[a] = (b->deforms ? at->box[1][a] : middle + half) + more;
    }
}

/* x (m, from the domain's corner) about the body's centre, in world and in rest axes. */
static void approach(const pose *at, const double x[3], double arm[3], double local[3])
{
    vec3_sub(arm, x, at->body->rigid.position);
    for (int a = 0; a < 3; a++)
        local[a] = at->matrix[0][a]*arm[0] + at->matrix[1][a]*arm[1] + at->matrix[2][a]*arm[2];
}

/* How far a particle is at least from the mesh, by its box, m. */
static double find_outside(const pose *at, const double x[3], const double local[3])
{
    const double *from = at->body->deforms ? x : local;
    double square = 0;
    for (int a = 0; a < at->step->dimension; a++) {
        const double below = at->box[0][a] - from[a], above = from[a] - at->box[1][a];
        const double d = below > above ? below : above;
        square += d > 0 ? d*d : 0;
    }
    return sqrt(square);
}

/* What the surface moves at a point of a triangle besides the body's rigid motion. */
static void find_deforming(const tobi_body *b, int32_t triangle, const double barycentric[3], tobi_contact *c)
{
    const int32_t *t = b->mesh.triangles[triangle];
    double turning[3];
    vec3_cross(turning, b->rigid.angular_velocity, c->arm);
    const int driven = b->rigid.kind == TOBI_PRESCRIBED;
    const double (*velocity)[3] = (const double (*)[3])(driven ? b->vertex_velocity :
                                                        b->swimmer ? b->swimmer->flow : NULL);
    for (int a = 0; a < 3; a++) {
        c->deforming[a] = driven ? -b->rigid.velocity[a] - turning[a] : 0;
        for (int k = 0; k < 3 && velocity; k++) c->deforming[a] += barycentric[k]*velocity[t[k]][a];
    }
}

/* The side of the cut that blade b is making on which the particle is: -1, 1, or 0 = not cut by it. *depth:
   m, how far from the cut it was in the material at rest. */
static int find_side(const tobi_body *b, const tobi_columns *cuts, double *depth)
{
    for (int k = 0; k < TOBI_CUTS_EACH; k++) {
        const tobi_float4 *c = &cuts->c[k];
        if (c->w == 0 || fabs(c->w) != b->rigid.cut) continue;
        *depth = sqrt((double)c->x*c->x + (double)c->y*c->y + (double)c->z*c->z);
        return c->w < 0 ? -1 : 1;
    }
    return 0;
}

/* What is known of a particle's distance from the surface, m: clear as of a candidate; if slot >= 0, its
   triangle is nearest and will be for this way more. */
typedef struct bounds { double clear, way; int32_t slot; } bounds;

/* Finds the nearest point, closer than far. Who has to look at the whole tree looks for the second nearest
   triangle, too: as long as it is farther whatever has moved, the one that was found will do. */
static int find_closest(const pose *at, const double x[3], const double local[3], double far, bounds *known,
                        tobi_bvh_hit *hit)
{
    const tobi_body *b = at->body;
    const tobi_bvh *tree = b->deforms ? b->bvh : b->rest_bvh;
    const double *point = b->deforms ? x : local;
    double others;
    if (known->slot >= 0) {
        hit->slot = known->slot;
        tobi_bvh_closest_again(tree, point, hit);
        return hit->distance < far;
    }
    known->way = 0;
    if (!tobi_bvh_closest_two(tree, point, far, hit, &others)) return 0;
    known->slot = hit->slot;
    known->way = 0.5*(others - hit->distance);
    return 1;
}

/* Nearest point of the body to x (from the domain's corner). Narrows the bounds. */
static int touch(const pose *at, const double x[3], const double local[3], tobi_contact *out, bounds *known)
{
    const tobi_body *b = at->body;
    tobi_bvh_hit hit;
    const double far = larger(at->reach, at->step->reach), farther = far + at->step->reach;
    double *clear = &known->clear;
    if (!find_closest(at, x, local, far, known, &hit)) {
        /* Outside its box nobody is inside the body. */
        if (*clear > 0) *clear = larger(*clear, far);
        else if (!find_closest(at, x, local, farther, known, &hit)) *clear = farther - far + at->reach;
        else *clear = hit.signed_distance > 0 ? hit.distance : hit.distance - far + at->reach;
        return 0;
    }
    out->depth = at->step->radius;
    out->gap = hit.signed_distance - out->depth;
    *clear = larger(*clear, hit.signed_distance);
    if (!(hit.signed_distance < at->reach)) return 0;
    for (int a = 0; a < 3; a++)
        out->normal[a] = b->deforms ? hit.normal[a] : vec3_dot(at->matrix[a], hit.normal);
    find_deforming(b, hit.triangle, hit.barycentric, out);
    return 1;
}

/* How far inside the stretch along the edge a place is where touch_blade goes by the cut and not by the mesh,
   m; < 0: how far outside; nobody gets across by moving less. With several edges, or one that cuts where it
   goes, 0 if it may be inside. */
static double find_inside(const pose *at, const double local[3], const tobi_blade_place *place)
{
    const tobi_blade_edge *e = at->body->edge_now;
    const double reach = at->step->reach;
    if (!at->plain) return smaller(0, sqrt(2)*reach - place->far);
    double from[3], inside = smaller(reach - fabs(place->aside), reach - fabs(place->ahead));
    if (at->step->dimension == 2) return inside;
    vec3_sub(from, local, e->from);
    const double way = vec3_dot(from, e->along);
    return smaller(inside, smaller(way, e->length - way));
}

/* A particle at a blade: what the edge has not passed yet meets the edge only; what it has passed meets the
   face of its own side, however thin the blade. What fills the place to the cut is the outermost layer of
   particles, wherever the cut lies between them: that keeps the faces a blade's thickness apart. 0: no
   contact. */
static int touch_blade(const pose *at, const double x[3], const double local[3], const tobi_columns *cuts,
                       tobi_contact *out, bounds *known)
{
    const double radius = at->step->radius, reach = at->step->reach;
    tobi_blade_place place = { 0 };
    double depth = radius;
    int side = find_side(at->body, cuts, &depth);
    if (depth > 2*radius) {
        known->clear = INFINITY;
        return 0;
    }
    int found = tobi_blade_locate(at->body, at->step->dimension, local, &place);
    int near = found && place.beyond == 0 && fabs(place.aside) < reach && fabs(place.ahead) < reach;
    const double inside = find_inside(at, local, &place);
    if (!side && near) {
        known->clear = larger(known->clear, inside + 2*radius);
        return 0;
    }
    if (!touch(at, x, local, out, known)) return 0;
    double normal[3], free = out->gap + radius - depth;    /* what the gap below is at least */
    if (side) free = smaller(free, at->plain ? larger(side*place.aside - depth, -inside) : -inside);
    known->clear = larger(known->clear, free + 2*radius);
    for (int a = 0; a < 3; a++) normal[a] = side*vec3_dot(at->matrix[a], place.normal);
    if (near && vec3_dot(normal, out->normal) < 0.2) {
        if (place.ahead > 0) return 0;         /* nearest is the edge or the other face */
        out->gap = side*place.aside - radius;
        memcpy(out->normal, normal, sizeof normal);
    }
    out->depth = depth;
    out->gap += radius - depth;
    return out->gap < at->step->margin;
}

/* 1 if the particle is held, by this body or by another that holds its solid: where beams of a frame overlap
   it would be held in one and pushed out of the other. */
static int is_held(const tobi_contact_step *step, const mpm_fields *f, int solid, int64_t i)
{
    return f->clamp[i].w != 0 && tobi_solid_is_clamped(&step->solids[solid], step->body);
}

/* Lists the particles of one chunk whose distance from the body's box is less than `far`. */
static int64_t list_chunk(const pose *at, const tobi_particles *p, int64_t chunk, double far,
                          const double low[3], const double high[3], candidate *out)
{
    const mpm_fields *f = mpm_fields_of(p);
    int64_t n = 0;
    for (int64_t i = chunk*TOBI_BLOCK; i < (chunk + 1)*TOBI_BLOCK && i < p->count; i++) {
        const double x[3] = {p->position[i].x, p->position[i].y, p->position[i].z};
        double arm[3], local[3];
        int outside = 0;
        for (int a = 0; a < at->step->dimension; a++) outside |= x[a] < low[a] || x[a] > high[a];
        if (outside || (f->clamp && is_held(at->step, f, p->fluid[i], i))) continue;
        approach(at, x, arm, local);
        const double clear = find_outside(at, x, local);
        if (clear < far) out[n++] = (candidate){(int32_t)i, 0, (float)(clear*(1 - 1e-6)), -1};
    }
    return n;
}

static int boxes_meet(const double box[6], const double low[3], const double high[3], int dimension,
                      double drift)
{
    int apart = 0;
    for (int a = 0; a < dimension; a++) apart |= box[a] > high[a] + drift || box[3 + a] < low[a] - drift;
    return !apart;
}

/* What the loops over blocks of particles or candidates need. */
typedef struct searching {
    tobi_contacts *c;
    struct tobi_contact_candidates *near;
    const pose *at;
    const tobi_particles *p;
    double far, low[3], high[3];       /* m, of candidates, and the box that they lie in */
} searching;

static void list_chunks(const void *view, int64_t begin, int64_t end)
{
    const searching *v = view;
    for (int64_t k = begin; k < end; k++)
        v->c->run[k].count = list_chunk(v->at, v->p, v->c->run[k].block, v->far, v->low, v->high,
                                        v->near->list + k*TOBI_BLOCK);
}

/* The list of candidates anew: all within `far`. */
static tobi_status list_candidates(tobi_contacts *c, struct tobi_contact_candidates *near, const pose *at,
                                   const tobi_particles *p, double far, tobi_exec *x, tobi_error *err)
{
    searching view = { .c = c, .near = near, .at = at, .p = p, .far = far };
    int64_t runs = 0;
    find_box(at, far, view.low, view.high);
    for (int64_t k = 0; k < count_chunks(p->count); k++)
        if (boxes_meet(c->chunk_box[k], view.low, view.high, at->step->dimension, c->drift))
            c->run[runs++] = (struct tobi_contact_run){k, 0};
    near->way = near->count = 0;
    if (runs*TOBI_BLOCK > near->room) {
        free(near->list);
        near->room = 0;
        near->list = malloc((size_t)(runs + runs/4 + 1)*TOBI_BLOCK*sizeof *near->list);
        if (!near->list) return fail_memory(runs*TOBI_BLOCK, err);
        near->room = (runs + runs/4 + 1)*TOBI_BLOCK;
    }
    tobi_loop(tobi_team(x, runs, 8), runs, 1, list_chunks, &view);
    for (int64_t k = 0; k < runs; k++) {
        memmove(near->list + near->count, near->list + k*TOBI_BLOCK,
                (size_t)c->run[k].count*sizeof *near->list);
        near->count += c->run[k].count;
    }
    return TOBI_OK;
}

/* How far a point of the body may have moved since it was last looked at, m. */
static double find_way(const pose *at, struct tobi_contact_candidates *near)
{
    const tobi_rigid *r = &at->body->rigid;
    double shift[3], turn = 0, size = 0, sign = 0;
    vec3_sub(shift, r->position, near->position);
    for (int a = 0; a < 4; a++) sign += r->orientation[a]*near->orientation[a];
    for (int a = 0; a < 4; a++) {
        const double change = r->orientation[a] - (sign < 0 ? -1 : 1)*near->orientation[a];
        turn += change*change;
    }
    for (int a = 0; a < 3; a++) {
        const double most = larger(fabs(at->box[0][a]), fabs(at->box[1][a]));
        size += most*most;
    }
    memcpy(near->position, r->position, sizeof near->position);
    memcpy(near->orientation, r->orientation, sizeof near->orientation);
    /* The two orientations differ by 2 sin(angle/4), and a point at r goes 2 r sin(angle/2). */
    return vec3_length(shift) + 2*sqrt(turn*size);
}

/* Brings the body's list of candidates up to date. */
static tobi_status find_candidates(tobi_contacts *c, struct tobi_contact_candidates *near, const pose *at,
                                   const tobi_particles *p, tobi_exec *x, tobi_error *err)
{
    const double skin = at->step->reach;
    const double way = find_way(at, near) + sqrt(3.0)*(c->drift - near->drift);
    const int known = near->body == at->body && !at->body->deforms && way >= 0;
    near->body = at->body;
    near->drift = c->drift;
    near->way += way*(1 + 1e-6);
    if (known && near->way + at->step->margin <= skin) return TOBI_OK;
    return list_candidates(c, near, at, p, at->reach - at->step->margin + skin, x, err);
}

/* A contact at which nothing can happen in this step: it did not push in the last one, and the particle, as
   it moves against the surface, ends farther from it than others could push it by, IDLE times the margin. One
   that overlaps counts whatever its velocity, so that a wrong guess is made good in the next step. */
static int is_idle(const pose *at, const tobi_contact *k, const tobi_float4 *velocity)
{
    const tobi_rigid *r = &at->body->rigid;
    double turning[3], along = 0;
    if (k->gap <= 0 || velocity->w < 0) return 0;
    vec3_cross(turning, r->angular_velocity, k->arm);
    for (int a = 0; a < 3; a++)
        along += k->normal[a]*((double)(&velocity->x)[a] - r->velocity[a] - turning[a] - k->deforming[a]);
    return k->gap + along*at->step->dt > IDLE*at->step->margin;
}

/* From the particle to the edge of its material, where it meets the surface. What deforms is known at the
   surface already. */
static void go_to_edge(const tobi_body *b, tobi_contact *k)
{
    double way[3], turning[3];
    for (int a = 0; a < 3; a++) way[a] = -k->depth*k->normal[a];
    vec3_cross(turning, b->rigid.angular_velocity, way);
    for (int a = 0; a < 3; a++) {
        k->arm[a] += way[a];
        if (b->rigid.kind == TOBI_PRESCRIBED) k->deforming[a] -= turning[a];
    }
}

static void prefetch(const tobi_particles *p, int64_t i)
{
    const mpm_fields *f = mpm_fields_of(p);
    __builtin_prefetch(&p->position[i]);
    __builtin_prefetch(&p->velocity[i]);
    if (f->cuts) __builtin_prefetch(&f->cuts[i]);
}

/* Looks at one candidate; whether it is a contact. */
static int look(const pose *at, const tobi_particles *p, double way, candidate *one, tobi_contact *out)
{
    const mpm_fields *f = mpm_fields_of(p);
    const double slack = 1e-6*at->reach;
    const int64_t i = one->particle;
    const double x[3] = {p->position[i].x, p->position[i].y, p->position[i].z};
    double local[3];
    *out = (tobi_contact){ .particle = (int32_t)i };
    approach(at, x, out->arm, local);
    bounds known = { one->clear - way, one->sure - way, way < one->sure ? one->slot : -1 };
    if (known.slot < 0) known.clear = find_outside(at, x, local);
    const int kept = known.slot, touches = known.clear <= at->reach + slack &&
        (f->cuts && at->body->blade ? touch_blade(at, x, local, &f->cuts[i], out, &known)
                                    : touch(at, x, local, out, &known)) &&
        !is_idle(at, out, &p->velocity[i]);
    one->clear = (float)((known.clear + way)*(1 - 1e-6));
    if (known.slot != kept) {
        one->slot = known.slot;
        one->sure = (float)((way + known.way)*(1 - 1e-6) - slack);
    }
    if (!touches) return 0;
    go_to_edge(at->body, out);
    const double start = larger(0, -p->velocity[i].w)*at->step->dt;
    for (int a = 0; a < 3; a++) out->change[a] = start*out->normal[a];
    return 1;
}

enum { AHEAD = 8 };                    /* particles that are on their way from memory             */

/* Contacts of one block of candidates into out; returns how many. */
static int64_t search_block(const pose *at, const tobi_particles *p, struct tobi_contact_candidates *near,
                            int64_t block, tobi_contact out[TOBI_BLOCK])
{
    const double least = at->reach*(1 + 1e-6) + near->way;
    int32_t asked[TOBI_BLOCK];
    int count = 0;
    int64_t n = 0;
    candidate *list = near->list + block*TOBI_BLOCK;
    for (int k = 0; k < TOBI_BLOCK && block*TOBI_BLOCK + k < near->count; k++)
        if (list[k].clear <= least) asked[count++] = k;
    for (int q = 0; q < count && q < AHEAD; q++) prefetch(p, list[asked[q]].particle);
    for (int q = 0; q < count; q++) {
        if (q + AHEAD < count) prefetch(p, list[asked[q + AHEAD]].particle);
        n += look(at, p, near->way, &list[asked[q]], &out[n]);
    }
    return n;
}

static void search_blocks(const void *view, int64_t begin, int64_t end)
{
    const searching *v = view;
    for (int64_t k = begin; k < end; k++)
        v->c->run[k].count = search_block(v->at, v->p, v->near, k, v->c->list + k*TOBI_BLOCK);
}

/* Lists the contacts in the order of the particles. */
static void search(tobi_contacts *c, struct tobi_contact_candidates *near, const pose *at,
                   const tobi_particles *p, tobi_exec *x)
{
    const int64_t runs = count_chunks(near->count);
    const int team = tobi_team(x, runs, 4);
    c->count = 0;
    for (int64_t k = 0; k < runs && team == 1; k++)
        c->count += search_block(at, p, near, k, c->list + c->count);
    if (team == 1) return;
    const searching view = { .c = c, .near = near, .at = at, .p = p };
    tobi_loop(team, runs, 1, search_blocks, &view);
    for (int64_t k = 0; k < runs; k++) {
        memmove(c->list + c->count, c->list + k*TOBI_BLOCK, (size_t)c->run[k].count*sizeof *c->list);
        c->count += c->run[k].count;
    }
}

tobi_status tobi_contact_reserve(tobi_contacts *c, int64_t count, tobi_error *err)
{
    const int64_t shifts = c->shift_count + count;
    if (shifts > c->shift_room) {
        tobi_shift *more = realloc(c->shift, (size_t)(shifts + shifts/4)*sizeof *more);
        if (!more) return fail_memory(shifts, err);
        c->shift = more;
        c->shift_room = shifts + shifts/4;
    }
    if (count <= c->room) return TOBI_OK;
    int64_t room = count + count/4 + 1024, parts = count_chunks(room);
    tobi_contact *list = realloc(c->list, (size_t)room*sizeof *list);
    if (list) c->list = list;
    double *partial = realloc(c->partial, (size_t)parts*TOBI_CONTACT_SUMS*sizeof *partial);
    if (partial) c->partial = partial;
    if (!list || !partial) return fail_memory(room, err);
    c->room = room;
    return TOBI_OK;
}

/* Bodies come in the same order in every step. */
static tobi_status take_candidates(tobi_contacts *c, struct tobi_contact_candidates **near, tobi_error *err)
{
    if (c->candidates_next == c->candidates_room) {
        const int room = 2*c->candidates_room + 1;
        struct tobi_contact_candidates *more = realloc(c->candidates, (size_t)room*sizeof *more);
        if (!more) return fail_memory(0, err);
        memset(more + c->candidates_room, 0, (size_t)(room - c->candidates_room)*sizeof *more);
        c->candidates = more;
        c->candidates_room = room;
    }
    *near = &c->candidates[c->candidates_next++];
    return TOBI_OK;
}

tobi_status tobi_contact_find(tobi_contacts *c, const tobi_particles *p, tobi_body *b,
                              const tobi_contact_step *step, tobi_exec *x, tobi_error *err)
{
    pose at;
    struct tobi_contact_candidates *near = NULL;
    if (!b->deforms) TOBI_TRY(tobi_body_build_rest(b, err));
    TOBI_TRY(take_candidates(c, &near, err));
    find_pose(b, step, &at);
    tobi_blade_update(b, step->dimension);
    TOBI_TRY(find_candidates(c, near, &at, p, x, err));
    TOBI_TRY(tobi_contact_reserve(c, (count_chunks(near->count) + 1)*TOBI_BLOCK, err));
    search(c, near, &at, p, x);
    memcpy(c->velocity, b->rigid.velocity, sizeof c->velocity);
    memcpy(c->spin, b->rigid.angular_velocity, sizeof c->spin);
    return TOBI_OK;
}

/* Looked for once: a piece does not move in rest axes. */
static const tobi_edge_foot *find_foot(tobi_body *b, const tobi_blade_piece *piece, double radius)
{
    tobi_edge_foot *foot = &b->edge_foot[piece->number];
    tobi_bvh_hit hit;
    if (foot->triangle >= 0) return foot;
    if (!tobi_bvh_closest(b->rest_bvh, piece->rest, 0.1*radius, &hit) &&     /* most edges lie on the mesh */
        !tobi_bvh_closest(b->rest_bvh, piece->rest, INFINITY, &hit)) return NULL;
    foot->triangle = hit.triangle;
    memcpy(foot->barycentric, hit.barycentric, sizeof foot->barycentric);
    return foot;
}

tobi_status tobi_contact_add_edge(tobi_contacts *c, tobi_body *b, const tobi_blade_piece *piece, double full,
                                  const tobi_contact_step *step, tobi_error *err)
{
    TOBI_TRY(tobi_contact_reserve(c, c->count + 1, err));
    tobi_contact *k = &c->list[c->count++];
    *k = (tobi_contact){ .particle = -1 - piece->number,
                         .limit = full*b->edge_resistance*piece->length*step->dt };
    memcpy(k->normal, piece->normal, sizeof k->normal);
    memcpy(k->ahead, piece->ahead, sizeof k->ahead);
    const double *share = b->edge_share[piece->number];
    vec3_add_scaled(k->change, share, -vec3_dot(share, k->normal), k->normal);
    for (int a = 0; a < 3; a++) k->change[a] *= k->limit;
    vec3_sub(k->arm, piece->middle, b->rigid.position);
    if (b->rigid.kind != TOBI_PRESCRIBED) return TOBI_OK;
    const tobi_edge_foot *foot = find_foot(b, piece, step->radius);
    if (foot) find_deforming(b, foot->triangle, foot->barycentric, k);
    return TOBI_OK;
}
