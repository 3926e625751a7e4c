#include "core/contact.h"
#include "base/error.h"
#include "core/cuts.h"
#include "geom/vec3.h"
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { MATRIX = 36, SUMS = MATRIX + 6, IMPULSES = 21 };

/* Contacts that one chunk of particles has with a body. */
struct tobi_contact_run { int64_t chunk, first, count; };

void tobi_contact_free(tobi_contacts *c)
{
    free(c->list);
    free(c->found);
    free(c->run);
    free(c->chunk_box);
    free(c->partial);
    free(c->shift);
    memset(c, 0, sizeof *c);
}

static int64_t count_chunks(int64_t n) { return (n + TOBI_BLOCK - 1)/TOBI_BLOCK; }

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
    if (drift > 0 && chunks <= c->chunk_room) return TOBI_OK;
    if (chunks > c->chunk_room) {
        free(c->run);
        free(c->chunk_box);
        c->run = malloc((size_t)chunks*sizeof *c->run);
        c->chunk_box = malloc((size_t)chunks*sizeof *c->chunk_box);
        c->chunk_room = c->run && c->chunk_box ? chunks : 0;
        if (!c->chunk_room) return fail_memory(p->count, err);
    }
    #pragma omp parallel for num_threads(x->threads)
    for (int64_t k = 0; k < chunks; k++) {
        double *box = c->chunk_box[k];
        for (int a = 0; a < 3; a++) { box[a] = INFINITY; box[3 + a] = -INFINITY; }
        for (int64_t i = k*TOBI_BLOCK; i < (k + 1)*TOBI_BLOCK && i < p->count; i++)
            for (int a = 0; a < 3; a++) {
                double v = (&p->position[i].x)[a];
                if (v < box[a]) box[a] = v;
                if (v > box[3 + a]) box[3 + a] = v;
            }
    }
    return TOBI_OK;
}

/* Where the body is, for one search. */
typedef struct pose {
    const tobi_body *body;
    const tobi_contact_step *step;
    double matrix[3][3];             /* rest axes to world axes */
    double low[3], high[3];          /* m, of the body with all who may touch it */
} pose;

/* The box around the body. The tree of the present pose is that of the start where a body moves by forces;
   the turned box of the rest pose holds whatever moved it. */
static void find_box(pose *at)
{
    const tobi_body *b = at->body;
    double low[3], high[3];
    tobi_bvh_box(b->deforms ? b->bvh : b->rest_bvh, low, high);
    for (int a = 0; a < 3; a++) {
        double middle = b->rigid.position[a], half = 0;
        for (int k = 0; k < 3; k++) {
            middle += 0.5*at->matrix[a][k]*(low[k] + high[k]);
            half += 0.5*fabs(at->matrix[a][k])*(high[k] - low[k]);
        }
        at->low[a] = (b->deforms ? low[a] : middle - half) - 2*at->step->radius - at->step->margin;
        at->high[a] = (b->deforms ? high[a] : middle + half) + 2*at->step->radius + at->step->margin;
    }
}

/* What the surface moves at the hit besides the body's rigid motion. */
static void find_deforming(const tobi_body *b, const tobi_bvh_hit *hit, tobi_contact *c)
{
    const int32_t *t = b->mesh.triangles[hit->triangle];
    double turning[3];
    vec3_cross(turning, b->rigid.angular_velocity, c->arm);
    for (int a = 0; a < 3; a++) {
        c->deforming[a] = b->rigid.kind == TOBI_PRESCRIBED ? -b->rigid.velocity[a] - turning[a] : 0;
        for (int k = 0; k < 3 && b->rigid.kind == TOBI_PRESCRIBED; k++)
            c->deforming[a] += hit->barycentric[k]*b->vertex_velocity[t[k]][a];
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

/* Nearest point of the body to x (from the domain's corner). */
static int touch(const pose *at, const double x[3], tobi_contact *out)
{
    const tobi_body *b = at->body;
    tobi_bvh_hit hit;
    const double reach = (b->blade ? 2 : 1)*at->step->radius + at->step->margin;
    double local[3], far = fmax(reach, at->step->reach);
    vec3_sub(out->arm, x, b->rigid.position);
    for (int a = 0; a < 3; a++)
        local[a] = at->matrix[0][a]*out->arm[0] + at->matrix[1][a]*out->arm[1] + at->matrix[2][a]*out->arm[2];
    int found = b->deforms ? tobi_bvh_closest(b->bvh, x, far, &hit)
                           : tobi_bvh_closest(b->rest_bvh, local, far, &hit);
    if (!found) return 0;
    out->gap = hit.signed_distance - at->step->radius;
    if (!(hit.signed_distance < reach)) return 0;
    for (int a = 0; a < 3; a++)
        out->normal[a] = b->deforms ? hit.normal[a] : vec3_dot(at->matrix[a], hit.normal);
    find_deforming(b, &hit, out);
    return 1;
}

/* A particle at a blade: what the edge has not passed yet meets the edge only; what it has passed meets the
   face of its own side, however thin the blade. What fills the place to the cut is the outermost layer of
   particles, wherever the cut lies between them: that keeps the faces a blade's thickness apart. 0: no
   contact. */
static int touch_blade(const pose *at, const double x[3], const tobi_columns *cuts, tobi_contact *out)
{
    const double radius = at->step->radius, reach = at->step->reach;
    tobi_blade_place place;
    double depth = radius;
    int side = find_side(at->body, cuts, &depth);
    double from[3], local[3];
    if (depth > 2*radius) return 0;
    vec3_sub(from, x, at->body->rigid.position);
    for (int a = 0; a < 3; a++)
        local[a] = at->matrix[0][a]*from[0] + at->matrix[1][a]*from[1] + at->matrix[2][a]*from[2];
    int known = tobi_blade_locate(at->body, at->step->dimension, local, &place);
    int near = known && place.beyond == 0 && fabs(place.aside) < reach && fabs(place.ahead) < reach;
    if (!side && near) return 0;
    if (!touch(at, x, out)) return 0;
    double normal[3];
    for (int a = 0; a < 3; a++) normal[a] = side*vec3_dot(at->matrix[a], place.normal);
    if (near && vec3_dot(normal, out->normal) < 0.2) {
        if (place.ahead > 0) return 0;         /* nearest is the edge or the other face */
        out->gap = side*place.aside - radius;
        memcpy(out->normal, normal, sizeof normal);
    }
    out->gap += radius - depth;
    return out->gap < at->step->margin;
}

/* Contacts of one chunk into `found`; returns how many. */
static int64_t search_chunk(const pose *at, const tobi_particles *p, int64_t chunk,
                            tobi_contact found[TOBI_BLOCK])
{
    int64_t n = 0;
    for (int64_t i = chunk*TOBI_BLOCK; i < (chunk + 1)*TOBI_BLOCK && i < p->count; i++) {
        double x[3] = {p->position[i].x, p->position[i].y, p->position[i].z};
        int out = 0;
        for (int a = 0; a < at->step->dimension; a++) out |= x[a] < at->low[a] || x[a] > at->high[a];
        found[n] = (tobi_contact){ .particle = (int32_t)i };
        if (out) continue;
        if (!(p->cuts && at->body->blade ? touch_blade(at, x, &p->cuts[i], &found[n])
                                         : touch(at, x, &found[n]))) continue;
        double start = fmax(0, -p->velocity[i].w)*at->step->dt;
        for (int a = 0; a < 3; a++) found[n].change[a] = start*found[n].normal[a];
        n++;
    }
    return n;
}

static int boxes_meet(const double box[6], const pose *at, double drift)
{
    int apart = 0;
    for (int a = 0; a < at->step->dimension; a++)
        apart |= box[a] > at->high[a] + drift || box[3 + a] < at->low[a] - drift;
    return !apart;
}

/* Fills `found` and the runs; returns how many contacts there are, more than `room` if that was too short. */
static int64_t search(tobi_contacts *c, const pose *at, const tobi_particles *p, int64_t *runs, tobi_exec *x)
{
    int64_t used = 0;
    *runs = 0;
    for (int64_t k = 0; k < count_chunks(p->count); k++)
        if (boxes_meet(c->chunk_box[k], at, c->drift))
            c->run[(*runs)++] = (struct tobi_contact_run){k, 0, 0};
    #pragma omp parallel for num_threads(x->threads) schedule(dynamic, 1) if (*runs > 1)
    for (int64_t k = 0; k < *runs; k++) {
        tobi_contact found[TOBI_BLOCK + 1];
        struct tobi_contact_run *run = &c->run[k];
        run->count = search_chunk(at, p, run->chunk, found);
        #pragma omp atomic capture
        { run->first = used; used += run->count; }
        if (run->first + run->count <= c->room)
            memcpy(c->found + run->first, found, (size_t)run->count*sizeof *found);
    }
    return used;
}

static tobi_status reserve(tobi_contacts *c, int64_t count, tobi_error *err)
{
    int64_t room = count + count/4 + 1024, parts = count_chunks(room);
    free(c->list);
    free(c->found);
    free(c->partial);
    c->list = malloc((size_t)room*sizeof *c->list);
    c->found = malloc((size_t)room*sizeof *c->found);
    c->partial = malloc((size_t)parts*SUMS*sizeof *c->partial);
    c->room = c->list && c->found && c->partial ? room : 0;
    return c->room ? TOBI_OK : fail_memory(count, err);
}

static tobi_status reserve_shifts(tobi_contacts *c, tobi_error *err)
{
    int64_t need = c->shift_count + c->count;
    if (need <= c->shift_room) return TOBI_OK;
    tobi_shift *more = realloc(c->shift, (size_t)(need + need/4)*sizeof *more);
    if (!more) return fail_memory(need, err);
    c->shift = more;
    c->shift_room = need + need/4;
    return TOBI_OK;
}

tobi_status tobi_contact_find(tobi_contacts *c, const tobi_particles *p, tobi_body *b,
                              const tobi_contact_step *step, tobi_exec *x, tobi_error *err)
{
    pose at = { .body = b, .step = step };
    int64_t runs;
    if (!b->deforms) TOBI_TRY(tobi_body_need_rest(b, err));
    tobi_quaternion_matrix(b->rigid.orientation, at.matrix);
    find_box(&at);
    while ((c->count = search(c, &at, p, &runs, x)) > c->room) TOBI_TRY(reserve(c, c->count, err));
    TOBI_TRY(reserve_shifts(c, err));
    int64_t n = 0;
    for (int64_t k = 0; k < runs; k++) {       /* in the order of the chunks, whoever was first */
        memcpy(c->list + n, c->found + c->run[k].first, (size_t)c->run[k].count*sizeof *c->list);
        n += c->run[k].count;
    }
    memcpy(c->velocity, b->rigid.velocity, sizeof c->velocity);
    memcpy(c->spin, b->rigid.angular_velocity, sizeof c->spin);
    return TOBI_OK;
}

/* Velocity of the material relative to the surface, for velocities of the body. */
static void find_relative(const tobi_contact *k, const double velocity[3], const double spin[3],
                          double out[3])
{
    double turning[3];
    vec3_cross(turning, spin, k->arm);
    for (int a = 0; a < 3; a++) out[a] = k->velocity[a] - velocity[a] - turning[a] - k->deforming[a];
}

static tobi_status make_room(tobi_contacts *c, tobi_error *err)
{
    if (c->count < c->room) return TOBI_OK;
    int64_t room = c->count + c->count/4 + 1024, parts = count_chunks(room);
    tobi_contact *list = realloc(c->list, (size_t)room*sizeof *list);
    if (list) c->list = list;
    tobi_contact *found = realloc(c->found, (size_t)room*sizeof *found);
    if (found) c->found = found;
    double *partial = realloc(c->partial, (size_t)parts*SUMS*sizeof *partial);
    if (partial) c->partial = partial;
    if (!list || !found || !partial) return fail_memory(room, err);
    c->room = room;
    return TOBI_OK;
}

tobi_status tobi_contact_add_edge(tobi_contacts *c, const tobi_body *b, const tobi_blade_piece *piece,
                                  double full, const tobi_contact_step *step, tobi_error *err)
{
    tobi_bvh_hit hit;
    double local[3], turn[3][3];
    TOBI_TRY(make_room(c, err));
    tobi_contact *k = &c->list[c->count++];
    *k = (tobi_contact){ .particle = -1, .limit = full*b->edge_resistance*piece->length*step->dt };
    memcpy(k->normal, piece->normal, sizeof k->normal);
    memcpy(k->ahead, piece->ahead, sizeof k->ahead);
    vec3_add_scaled(k->change, b->rigid.edge_share, -vec3_dot(b->rigid.edge_share, k->normal), k->normal);
    for (int a = 0; a < 3; a++) k->change[a] *= k->limit;
    vec3_sub(k->arm, piece->middle, b->rigid.position);
    if (b->rigid.kind != TOBI_PRESCRIBED) return TOBI_OK;
    tobi_quaternion_matrix(b->rigid.orientation, turn);
    for (int a = 0; a < 3; a++)
        local[a] = turn[0][a]*k->arm[0] + turn[1][a]*k->arm[1] + turn[2][a]*k->arm[2];
    if (tobi_bvh_closest(b->rest_bvh, local, INFINITY, &hit)) find_deforming(b, &hit, k);
    return TOBI_OK;
}

void tobi_contact_aim(tobi_contacts *c, const tobi_body *b, const tobi_contact_step *step, tobi_exec *x)
{
    #pragma omp parallel for num_threads(x->threads) if (c->count > TOBI_BLOCK)
    for (int64_t n = 0; n < c->count; n++) {
        tobi_contact *k = &c->list[n];
        double relative[3];
        if (k->particle < 0) continue;
        find_relative(k, c->velocity, c->spin, relative);
        double along = vec3_dot(relative, k->normal);
        int hits = -along > step->rest_speed && k->gap < -along*step->dt;
        k->bounce = hits ? -along*b->rigid.restitution : 0;
    }
}

/* By how much the velocity must change along the normal, if at all. */
static double find_lack(const tobi_contact *k, double along, double dt)
{
    double allowed = k->bounce > 0 ? k->bounce : -fmax(k->gap, 0)/dt;
    return allowed - along;
}

/* The impulse of a contact for given velocities of the body: into change. */
static void find_change(tobi_contact *k, const tobi_contacts *c, double friction, double dt)
{
    double relative[3], wanted[3], normal, slide[3];
    find_relative(k, c->velocity, c->spin, relative);
    double along = vec3_dot(relative, k->normal), lack = find_lack(k, along, dt);
    normal = fmax(0, vec3_dot(k->impulse, k->normal) + lack/k->mobility);
    for (int a = 0; a < 3; a++) {
        double sliding = relative[a] - along*k->normal[a];
        wanted[a] = k->impulse[a] - sliding/k->mobility;
    }
    vec3_add_scaled(slide, wanted, -vec3_dot(wanted, k->normal), k->normal);
    double size = vec3_length(slide), grip = friction*normal;
    k->sliding = size > grip;
    for (int a = 0; a < 3; a++)
        k->change[a] = normal*k->normal[a] + (k->sliding ? slide[a]*grip/size : slide[a]) - k->impulse[a];
}

/* The same of an edge: it holds the material within the plane of the cut as long as the force, which then
   points where the edge goes, is not enough to cut. */
static void find_edge_change(tobi_contact *k, const tobi_contacts *c)
{
    double relative[3], wanted[3];
    find_relative(k, c->velocity, c->spin, relative);
    vec3_add_scaled(relative, relative, -vec3_dot(relative, k->normal), k->normal);
    vec3_add_scaled(wanted, k->impulse, -1/k->mobility, relative);
    double size = vec3_length(wanted);
    double most = size > 0 ? k->limit*fmax(0, vec3_dot(wanted, k->ahead)/size) : 0;
    k->sliding = size > most;
    for (int a = 0; a < 3; a++)
        k->change[a] = (k->sliding && size > 0 ? wanted[a]*most/size : wanted[a]) - k->impulse[a];
}

/* Adds G^T P G and G^T P (v - aim) over mobility, where G takes the body's six velocities to the contact
   and P keeps what of them its impulse answers: the normal part if it pushes, the rest if it does not
   slide. */
static void add_contact(const tobi_contact *k, const tobi_contacts *c, double dt, double *sum)
{
    double relative[3], p[3][3], g[3][6] = {{0}}, pg[3][6], aim[3];
    find_relative(k, c->velocity, c->spin, relative);
    const int edge = k->particle < 0, stick = !k->sliding;
    double lack = find_lack(k, vec3_dot(relative, k->normal), dt);
    if (edge ? !stick : vec3_dot(k->impulse, k->normal) + lack/k->mobility <= 0) return;
    double allowed = k->bounce > 0 || edge ? k->bounce : -fmax(k->gap, 0)/dt;
    for (int r = 0; r < 3; r++)
        for (int n = 0; n < 3; n++)
            p[r][n] = ((edge ? -1 : !stick)*k->normal[r]*k->normal[n] + (r == n && stick))/k->mobility;
    for (int a = 0; a < 3; a++) {
        g[a][a] = 1;
        aim[a] = k->velocity[a] - k->deforming[a] - allowed*k->normal[a];
    }
    g[0][4] = k->arm[2]; g[0][5] = -k->arm[1];
    g[1][3] = -k->arm[2]; g[1][5] = k->arm[0];
    g[2][3] = k->arm[1]; g[2][4] = -k->arm[0];
    for (int r = 0; r < 3; r++)
        for (int n = 0; n < 6; n++) pg[r][n] = p[r][0]*g[0][n] + p[r][1]*g[1][n] + p[r][2]*g[2][n];
    for (int i = 0; i < 6; i++) {
        for (int n = 0; n < 6; n++) sum[6*i + n] += g[0][i]*pg[0][n] + g[1][i]*pg[1][n] + g[2][i]*pg[2][n];
        sum[MATRIX + i] += pg[0][i]*aim[0] + pg[1][i]*aim[1] + pg[2][i]*aim[2];
    }
}

/* Solves the 6x6 system a x = b by Gauss with pivots; leaves x in b. */
static void eliminate(double a[6][6], double b[6])
{
    for (int k = 0; k < 6; k++) {
        int best = k;
        for (int i = k + 1; i < 6; i++) if (fabs(a[i][k]) > fabs(a[best][k])) best = i;
        for (int j = 0; j < 6; j++) { double t = a[k][j]; a[k][j] = a[best][j]; a[best][j] = t; }
        double t = b[k]; b[k] = b[best]; b[best] = t;
        for (int i = k + 1; i < 6; i++) {
            double f = a[i][k]/a[k][k];
            for (int j = k; j < 6; j++) a[i][j] -= f*a[k][j];
            b[i] -= f*b[k];
        }
    }
    for (int k = 5; k >= 0; k--) {
        for (int j = k + 1; j < 6; j++) b[k] -= a[k][j]*b[j];
        b[k] /= a[k][k];
    }
}

/* Sums `width` numbers per contact over the list, in one order for any number of threads. */
static void sum_contacts(tobi_contacts *c, int width, double dt, double *total, tobi_exec *x)
{
    int64_t parts = count_chunks(c->count);
    memset(total, 0, (size_t)width*sizeof *total);
    #pragma omp parallel for num_threads(x->threads) schedule(dynamic, 1) if (parts > 1)
    for (int64_t q = 0; q < parts; q++) {
        double *sum = c->partial + q*SUMS;
        memset(sum, 0, (size_t)width*sizeof *sum);
        for (int64_t n = q*TOBI_BLOCK; n < (q + 1)*TOBI_BLOCK && n < c->count; n++) {
            const tobi_contact *k = &c->list[n];
            double twist[3];
            if (width == SUMS) {
                add_contact(k, c, dt, sum);
                continue;
            }
            vec3_cross(twist, k->arm, k->change);
            for (int a = 0; a < 3; a++) { sum[a] += k->change[a]; sum[3 + a] += twist[a]; }
        }
    }
    for (int64_t q = 0; q < parts; q++)
        for (int n = 0; n < width; n++) total[n] += c->partial[q*SUMS + n];
}

/* The foreseen velocities after the impulses of this sweep, solved with them: V = V0 + M^-1 (r - K V). */
static void foresee(tobi_contacts *c, const tobi_rigid *r, double dt, tobi_exec *x)
{
    double shift[3], turn[3][3], inverse[6][6] = {{0}}, total[SUMS], a[6][6], b[6];
    tobi_rigid_inverse(r, shift, turn);
    for (int i = 0; i < 3; i++) {
        inverse[i][i] = shift[i];
        for (int k = 0; k < 3; k++) inverse[3 + i][3 + k] = turn[i][k];
    }
    sum_contacts(c, SUMS, dt, total, x);
    memcpy(b, c->velocity, sizeof c->velocity);
    memcpy(b + 3, c->spin, sizeof c->spin);
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < 6; k++) a[i][k] = i == k;
        for (int j = 0; j < 6; j++) {
            for (int k = 0; k < 6; k++) a[i][k] += inverse[i][j]*total[6*j + k];
            b[i] += inverse[i][j]*total[MATRIX + j];
        }
    }
    eliminate(a, b);
    memcpy(c->velocity, b, sizeof c->velocity);
    memcpy(c->spin, b + 3, sizeof c->spin);
}

double tobi_contact_sweep(tobi_contacts *c, tobi_body *b, const tobi_contact_step *step, int first,
                          tobi_exec *x)
{
    const tobi_rigid *r = &b->rigid;
    double most = 0, largest = 0;
    int moves = r->kind != TOBI_PRESCRIBED;
    double velocity[3], spin[3], total[6];
    memcpy(velocity, c->velocity, sizeof velocity);
    memcpy(spin, c->spin, sizeof spin);
    if (moves && !first) foresee(c, r, step->dt, x);
    #pragma omp parallel for num_threads(x->threads) if (c->count > TOBI_BLOCK) reduction(max: most, largest)
    for (int64_t n = 0; n < c->count; n++) {
        tobi_contact *k = &c->list[n];
        if (!first && k->particle < 0) find_edge_change(k, c);
        else if (!first) find_change(k, c, r->friction, step->dt);
        for (int a = 0; a < 3; a++) k->impulse[a] += k->change[a];
        most = fmax(most, vec3_dot(k->change, k->change));
        largest = fmax(largest, vec3_dot(k->impulse, k->impulse));
    }
    const double moved = most > 0 ? sqrt(most/fmax(largest, 1e-300)) : 0;
    if (!moves) return moved;
    /* What the impulses really were. */
    double shift[3], turn[3][3];
    tobi_rigid_inverse(r, shift, turn);
    sum_contacts(c, 6, step->dt, total, x);
    for (int a = 0; a < 3; a++) {
        c->velocity[a] = velocity[a] - shift[a]*total[a];
        c->spin[a] = spin[a] - vec3_dot(turn[a], total + 3);
    }
    return moved;
}

/* The part of an overlap that is mended in one step, m. */
static double find_push(const tobi_contact *k, const tobi_contact_step *step)
{
    return k->gap < 0 ? fmin(-0.2*k->gap, 0.1*step->radius) : 0;
}

void tobi_contact_shift(tobi_contacts *c, tobi_particles *p)
{
    for (int64_t n = 0; n < c->shift_count; n++)
        for (int a = 0; a < 3; a++) (&p->position[c->shift[n].particle].x)[a] += c->shift[n].by[a];
    c->shift_count = 0;
}

int64_t tobi_contact_finish(tobi_contacts *c, tobi_particles *p, tobi_body *b, const tobi_contact_step *step,
                            double *far, tobi_contact_work *work, tobi_exec *x)
{
    int64_t parts = count_chunks(c->count);
    double total[IMPULSES] = {0}, dt = step->dt;
    #pragma omp parallel for num_threads(x->threads) schedule(dynamic, 1) if (parts > 1)
    for (int64_t q = 0; q < parts; q++) {
        double *sum = c->partial + q*SUMS;
        memset(sum, 0, IMPULSES*sizeof *sum);
        for (int64_t n = q*TOBI_BLOCK; n < (q + 1)*TOBI_BLOCK && n < c->count; n++) {
            const tobi_contact *k = &c->list[n];
            const int edge = k->particle < 0;
            double part[2][3], twist[3], relative[3], normal = vec3_dot(k->impulse, k->normal);
            for (int a = 0; a < 3; a++) {
                part[0][a] = edge ? -k->impulse[a] : -normal*k->normal[a];
                part[1][a] = -k->impulse[a] - part[0][a];
            }
            find_relative(k, c->velocity, c->spin, relative);
            sum[edge ? 14 : 15] -= vec3_dot(k->impulse, relative);
            sum[16] += vec3_dot(k->impulse, k->velocity);
            for (int m = 0; m < 2; m++) {
                vec3_cross(twist, k->arm, part[m]);
                for (int a = 0; a < 3; a++) { sum[6*m + a] += part[m][a]; sum[6*m + 3 + a] += twist[a]; }
            }
            for (int a = 0; a < 3 && edge; a++) sum[17 + a] -= k->impulse[a];
            if (edge) sum[12] += vec3_dot(k->impulse, k->impulse) > 0;
            if (edge) sum[20] += k->limit;
            if (edge) continue;
            sum[12] += normal > 0;
            p->velocity[k->particle].w = (float)(normal/dt);
            sum[13] = fmax(sum[13], find_push(k, step));
        }
    }
    for (int64_t n = 0; n < c->count; n++) {
        const tobi_contact *k = &c->list[n];
        if (!(k->gap < 0) || k->particle < 0) continue;
        tobi_shift *shift = &c->shift[c->shift_count++];
        *shift = (tobi_shift){ .particle = k->particle };
        for (int a = 0; a < step->dimension; a++) shift->by[a] = find_push(k, step)*k->normal[a];
    }
    for (int64_t q = 0; q < parts; q++) {
        for (int n = 0; n < IMPULSES; n++) total[n] += c->partial[q*SUMS + n];
        *far = fmax(*far, c->partial[q*SUMS + 13]);
    }
    work->fracture += total[14];
    work->friction += total[15];
    work->bodies += total[14] + total[15] + total[16];
    for (int a = 0; a < 3; a++) {
        b->rigid.impulse[a] += total[a] + total[6 + a];
        b->rigid.twist[a] += total[3 + a] + total[9 + a];
        b->info.pressure_force[a] = total[a]/dt;
        b->info.edge_force[a] = total[17 + a]/dt;
        b->rigid.edge_share[a] = total[20] > 0 ? -total[17 + a]/total[20] : 0;
        b->info.pressure_torque[a] = total[3 + a]/dt;
        b->info.viscous_force[a] = total[6 + a]/dt;
        b->info.viscous_torque[a] = total[9 + a]/dt;
    }
    /* Touched, it moves as it will, or a resting body would fall into the material in every step. */
    if (b->rigid.kind != TOBI_PRESCRIBED && total[12] > 0) tobi_body_correct(b, c->velocity, c->spin, dt);
    return (int64_t)total[12];
}
