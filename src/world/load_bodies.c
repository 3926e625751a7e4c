/* Bodies from a checkpoint. All that may fail comes first: reading, checks, memory. Then the world takes it
   over. Bodies with a motion are put where the file has their vertices, and the motion is not asked: it may
   fail, and it may not be the one they were moved by. Drawback: the vertices are stored. */
#include "base/error.h"
#include "rigid/dynamics.h"
#include "world/absorb.h"
#include "world/bodies.h"
#include "world/nest.h"
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct tobi_loaded_body {
    double state[TOBI_RIGID_DOUBLES];
    double finer[7];                 /* and finer_by; 0 where no nest moves it                    */
    double load[7];                  /* N, N m: its constant force and torque; 1: its motion was set */
    tobi_body_info info;
    double (*vertex)[3], (*before)[3];   /* of a body with a motion, owned                        */
    double (*shape)[3];              /* of a swimmer, owned: tobi_swimmer_save                    */
    tobi_body_at place;
    double (*edge_share)[3];         /* [piece_count] of a blade, owned until taken               */
    tobi_edge_foot *edge_foot;
    int64_t piece_count;
    double memory[TOBI_CONTROL_STATE];       /* of a control program                             */
    double absorb[TOBI_ABSORB_DOUBLES];      /* of a piston that absorbs                         */
};

/* A mesh that was replaced meanwhile is another body: its state would go on with another mass. */
static tobi_status check_same(const tobi_body *b, const tobi_body_info *then, tobi_error *err)
{
    const double tiny = 1e-9, volume = b->rest.volume, mass = b->rigid.mass;
    if (fabs(then->volume - volume) <= tiny*fabs(volume) && fabs(then->mass - mass) <= tiny*fabs(mass) &&
        then->particles == b->particle_count) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "the checkpoint is of another scene: body '%s' has %.10g m3, %.10g "
                     "kg and %lld particles in it, %.10g m3, %.10g kg and %lld in the scene; was its mesh "
                     "changed?",
                     b->name, then->volume, then->mass, (long long)then->particles, volume, mass,
                     (long long)b->particle_count);
}

static int differ(const double *a, const double *b, int count, double size)
{
    for (int k = 0; k < count; k++)
        if (!(fabs(a[k] - b[k]) <= 1e-9*size)) return 1;
    return 0;
}

/* A given centre of mass or inertia that was changed. The inertia of a swimmer is that of its shape. */
static tobi_status check_matter(const tobi_body *b, int k, tobi_store *f, const tobi_body_info *then,
                                tobi_error *err)
{
    const double *m = b->rigid.inertia, *n = then->inertia, *now = b->middle;
    double middle[3];
    char name[32];
    if (!b->swimmer && differ(m, n, 9, fabs(m[0]) + fabs(m[4]) + fabs(m[8])))
        return tobi_fail(err, TOBI_INVALID, "the checkpoint is of another scene: the inertia of body '%s' is "
                         "(%.10g, %.10g, %.10g) kg m2 with products (%.10g, %.10g, %.10g) in it, (%.10g, "
                         "%.10g, %.10g) with (%.10g, %.10g, %.10g) in the scene", b->name, n[0], n[4], n[8],
                         n[1], n[2], n[5], m[0], m[4], m[8], m[1], m[2], m[5]);
    tobi_world_name_body(k, "_middle", name);
    TOBI_TRY(tobi_store_get(f, name, TOBI_F64, 3, 1, middle, err));
    if (!differ(now, middle, 3, cbrt(b->rest.volume))) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "the checkpoint is of another scene: in it the middle of body '%s' "
                     "lies (%.10g, %.10g, %.10g) m from its centre of mass, in the scene (%.10g, %.10g, "
                     "%.10g) m; was its centre_of_mass changed?", b->name, middle[0], middle[1], middle[2],
                     now[0], now[1], now[2]);
}

static tobi_status read_state(const tobi_body *b, int k, tobi_store *f, tobi_loaded_body *l, tobi_error *err)
{
    char name[32];
    tobi_world_name_body(k, "_state", name);
    TOBI_TRY(tobi_store_get(f, name, TOBI_F64, TOBI_RIGID_DOUBLES, 1, l->state, err));
    tobi_world_name_body(k, "_load", name);
    TOBI_TRY(tobi_store_get(f, name, TOBI_F64, 7, 1, l->load, err));
    tobi_world_name_body(k, "", name);
    TOBI_TRY(tobi_store_get(f, name, TOBI_U8, (int64_t)sizeof l->info, 1, &l->info, err));
    TOBI_TRY(check_same(b, &l->info, err));
    TOBI_TRY(check_matter(b, k, f, &l->info, err));
    tobi_world_name_body(k, "_memory", name);
    if (b->rigid.control && tobi_store_has(f, name))         /* older ones have none */
        TOBI_TRY(tobi_store_get(f, name, TOBI_F64, TOBI_CONTROL_STATE, 1, l->memory, err));
    tobi_world_name_body(k, "_nest", name);
    memset(l->finer, 0, sizeof l->finer);
    if (tobi_store_has(f, name)) TOBI_TRY(tobi_store_get(f, name, TOBI_F64, 7, 1, l->finer, err));
    int good = l->finer[6] >= 0 && l->finer[6] <= INT_MAX;
    for (int i = 0; i < 7; i++) good &= isfinite(l->finer[i]) != 0;
    for (int i = 0; i < TOBI_CONTROL_STATE; i++) good &= isfinite(l->memory[i]) != 0;
    for (int i = 0; i < TOBI_RIGID_DOUBLES; i++) good &= isfinite(l->state[i]) != 0;
    for (int i = 0; i < 7; i++) good &= isfinite(l->load[i]) != 0;
    if (good) return TOBI_OK;
    return tobi_fail(err, TOBI_DAMAGED, "the checkpoint's state of body '%s' is no number", b->name);
}

static tobi_status read_edge(const tobi_body *b, int k, tobi_store *f, tobi_loaded_body *l, tobi_error *err)
{
    char name[32];
    int64_t count = 0;
    tobi_world_name_body(k, "_edge", name);
    TOBI_TRY(tobi_store_rows(f, name, &count, err));
    l->edge_share = calloc((size_t)count + 1, sizeof *l->edge_share);
    l->edge_foot = malloc((size_t)(count + 1)*sizeof *l->edge_foot);
    l->piece_count = count;
    if (!l->edge_share || !l->edge_foot)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the edge of '%s'", b->name);
    TOBI_TRY(tobi_store_get(f, name, TOBI_F64, count, 3, l->edge_share, err));
    for (int64_t n = 0; n < count; n++) {
        l->edge_foot[n].triangle = -1;
        for (int a = 0; a < 3; a++)
            if (!(fabs(l->edge_share[n][a]) <= 2))
                return tobi_fail(err, TOBI_DAMAGED, "the checkpoint's state of the edge of '%s' is no share",
                                 b->name);
    }
    return TOBI_OK;
}

static tobi_status read_place(const tobi_body *b, int k, tobi_store *f, tobi_loaded_body *l, tobi_error *err)
{
    const int64_t count = b->mesh.vertex_count;
    char name[32];
    l->vertex = malloc((size_t)(count + 1)*sizeof *l->vertex);
    l->before = malloc((size_t)(count + 1)*sizeof *l->before);
    if (!l->vertex || !l->before)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the vertices of '%s'", b->name);
    tobi_world_name_body(k, "_vertex", name);
    TOBI_TRY(tobi_store_get(f, name, TOBI_F64, count, 3, l->vertex, err));
    tobi_world_name_body(k, "_before", name);
    TOBI_TRY(tobi_store_get(f, name, TOBI_F64, count, 3, l->before, err));
    tobi_world_name_body(k, "_place", name);
    TOBI_TRY(tobi_store_get(f, name, TOBI_F64, 4, 3, &l->place, err));
    int good = 1;
    for (int64_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++) good &= isfinite(l->vertex[i][a]) && isfinite(l->before[i][a]);
    for (int a = 0; a < 3; a++) {
        good &= isfinite(l->place.centre[a]) != 0;
        for (int i = 0; i < 3; i++) good &= isfinite(l->place.frame[i][a]) != 0;
    }
    if (good) return TOBI_OK;
    return tobi_fail(err, TOBI_DAMAGED, "the checkpoint's place of body '%s' is no number", b->name);
}

static tobi_status read_absorber(const tobi_world *w, int k, tobi_store *f, tobi_loaded_body *l,
                                 tobi_error *err)
{
    char name[32];
    int good = 1;
    if (!tobi_absorb_state(w, k)) return TOBI_OK;
    tobi_world_name_body(k, "_absorb", name);
    TOBI_TRY(tobi_store_get(f, name, TOBI_F64, TOBI_ABSORB_DOUBLES, 1, l->absorb, err));
    for (int n = 0; n < TOBI_ABSORB_DOUBLES; n++) good &= isfinite(l->absorb[n]) != 0;
    if (good) return TOBI_OK;
    return tobi_fail(err, TOBI_DAMAGED, "the checkpoint's way of the piston '%s' is no number",
                     w->sim.bodies[k].name);
}

static tobi_status read_shape(const tobi_body *b, int k, tobi_store *f, tobi_loaded_body *l, tobi_error *err)
{
    const int64_t count = b->swimmer->count + TOBI_SWIMMER_MORE;
    char name[32];
    double inertia[9], inverse[9];
    l->shape = malloc((size_t)count*sizeof *l->shape);
    if (!l->shape) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the shape of '%s'", b->name);
    tobi_world_name_body(k, "_shape", name);
    TOBI_TRY(tobi_store_get(f, name, TOBI_F64, count, 3, l->shape, err));
    int good = tobi_swimmer_inertia(b->swimmer, (const double (*)[3])l->shape, inertia, inverse);
    for (int64_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++) good &= isfinite(l->shape[i][a]) != 0;
    if (good) return TOBI_OK;
    return tobi_fail(err, TOBI_DAMAGED, "the checkpoint's shape of body '%s' is that of no body", b->name);
}

static tobi_status read_contacts(tobi_store *f, tobi_loaded_bodies *l, tobi_error *err)
{
    int64_t n = 0;
    TOBI_TRY(tobi_store_rows(f, "body_contacts", &n, err));
    l->contacts = malloc((size_t)(n + TOBI_WARM)*sizeof *l->contacts);
    if (!l->contacts) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld contacts", (long long)n);
    l->contact_count = n/TOBI_WARM;
    return tobi_store_get(f, "body_contacts", TOBI_F64, n, 1, l->contacts, err);
}

tobi_status tobi_world_read_bodies(tobi_world *w, tobi_store *f, tobi_loaded_bodies *l, tobi_error *err)
{
    *l = (tobi_loaded_bodies){ .count = w->sim.body_count };
    l->body = calloc((size_t)l->count + 1, sizeof *l->body);
    if (!l->body) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %d bodies", l->count);
    for (int k = 0; k < l->count; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        TOBI_TRY(read_state(b, k, f, &l->body[k], err));
        if (b->blade) TOBI_TRY(read_edge(b, k, f, &l->body[k], err));
        if (b->motion) TOBI_TRY(read_place(b, k, f, &l->body[k], err));
        TOBI_TRY(read_absorber(w, k, f, &l->body[k], err));
        if (b->swimmer) TOBI_TRY(read_shape(b, k, f, &l->body[k], err));
    }
    TOBI_TRY(tobi_motors_read(w, f, &l->motors, err));
    return w->dynamics ? read_contacts(f, l, err) : TOBI_OK;
}

static void take_edge(tobi_body *b, tobi_loaded_body *l)
{
    free(b->edge_share);
    free(b->edge_foot);
    b->edge_share = l->edge_share;
    b->edge_foot = l->edge_foot;
    b->piece_count = l->piece_count;
    l->edge_share = NULL;
    l->edge_foot = NULL;
}

static void take_body(const tobi_world *w, tobi_body *b, tobi_loaded_body *l)
{
    tobi_rigid rigid = b->rigid;
    memcpy(TOBI_RIGID_STATE(&rigid), l->state, sizeof l->state);
    memcpy(rigid.memory, l->memory, sizeof rigid.memory);
    memcpy(rigid.force, l->load, sizeof rigid.force);
    memcpy(rigid.torque, l->load + 3, sizeof rigid.torque);
    memcpy(rigid.finer, l->finer, sizeof rigid.finer);
    rigid.finer_by = (int)l->finer[6];
    if (!tobi_nest_numbered(w, rigid.finer_by)) rigid.finer_by = 0;
    if (!rigid.finer_by) memset(rigid.finer, 0, sizeof rigid.finer);
    rigid.phase = fmin(fmax(rigid.phase, -1e9), 1e9);
    rigid.hold = (int)fmin(fmax(rigid.hold, 0), 63) & 63;
    b->rigid = rigid;
    if (b->swimmer) tobi_swimmer_restore(b, (const double (*)[3])l->shape);
    memcpy(rigid.inertia, b->rigid.inertia, sizeof rigid.inertia);
    memcpy(rigid.inverse, b->rigid.inverse, sizeof rigid.inverse);
    if (b->motion) {
        tobi_body_restore(b, (const double (*)[3])l->vertex, &l->place);
        memcpy(b->vertex_before, l->before, (size_t)b->mesh.vertex_count*sizeof *l->before);
    }
    else b->is_absent = 0, tobi_body_place(b, 0, NULL);      /* by its state, or at rest: neither can fail */
    b->rigid = rigid;                      /* placing a body at rest forgets its velocities */
    b->info = l->info;
    b->motion_set = b->motion_due = b->motion && l->load[6] > 0;
    if (b->blade) take_edge(b, l);
    tobi_body_clear_loads(b);
    memset(b->power, 0, sizeof b->power);
}

tobi_status tobi_world_take_bodies(tobi_world *w, tobi_loaded_bodies *l, tobi_error *err)
{
    if (w->dynamics) TOBI_TRY(tobi_rigid_set_warm(w->dynamics, l->contact_count, l->contacts, err));
    for (int k = 0; k < l->count; k++) {
        double *absorb = tobi_absorb_state(w, k);
        take_body(w, &w->sim.bodies[k], &l->body[k]);
        if (absorb) memcpy(absorb, l->body[k].absorb, sizeof l->body[k].absorb);
    }
    tobi_absorb_restore(w);
    if (w->dynamics) tobi_rigid_follow(w->dynamics);
    tobi_constraints_report(&w->sim.constraints, w->sim.bodies, 0);
    for (int k = 0; k < l->count; k++) tobi_joint_report(&w->sim.bodies[k].rigid, 0);
    return TOBI_OK;
}

void tobi_loaded_bodies_free(tobi_loaded_bodies *l)
{
    for (int k = 0; l->body && k < l->count; k++) {
        free(l->body[k].vertex);
        free(l->body[k].before);
        free(l->body[k].shape);
        free(l->body[k].edge_share);
        free(l->body[k].edge_foot);
    }
    free(l->body);
    free(l->contacts);
    free(l->motors);
    *l = (tobi_loaded_bodies){ 0 };
}
