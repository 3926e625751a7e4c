/* Sweeps over the contacts of one body: each asks for an impulse that ends its approach, and a matrix
   of six sums what the body answers. Drawback: contacts of a sweep do not know of one another, so that
   it takes several. */
#include "mpm/contact/contact.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

enum { MATRIX = 36, SUMS = TOBI_CONTACT_SUMS };
_Static_assert(SUMS == MATRIX + 6, "a matrix and a vector of six");

/* Of the impulse by the sum of its row, which asks too little of contacts that push unequally: with more,
   fewer sweeps do. A common motion then goes back and forth by what is more than 1; a body that moves would
   go with it. */
static const double PACE = 1.4;

/* fmax is a call. */
static double larger(double a, double b) { return a > b ? a : b; }

static int64_t count_parts(const tobi_contacts *c) { return (c->count + TOBI_BLOCK - 1)/TOBI_BLOCK; }

/* Velocity of the material relative to the surface, for velocities of the body. */
static void find_relative(const tobi_contact *k, const double velocity[3], const double spin[3],
                          double out[3])
{
    double turning[3];
    vec3_cross(turning, spin, k->arm);
    for (int a = 0; a < 3; a++) out[a] = k->velocity[a] - velocity[a] - turning[a] - k->deforming[a];
}

/* What the loops over contacts read. */
typedef struct visiting {
    tobi_contacts *c;
    const tobi_rigid *body;
    const tobi_contact_step *step;
    double dt;
    int width;                         /* numbers per contact that are summed     */
    int first, moves;                  /* the first sweep; a body that moves      */
    double pace;
    tobi_particles *particles;
} visiting;

static void aim_contacts(const void *view, int64_t begin, int64_t end)
{
    const visiting *v = view;
    for (int64_t n = begin; n < end; n++) {
        tobi_contact *k = &v->c->list[n];
        double relative[3];
        if (k->particle < 0) continue;
        find_relative(k, v->c->velocity, v->c->spin, relative);
        double along = vec3_dot(relative, k->normal);
        int hits = -along > v->step->rest_speed && k->gap < -along*v->step->dt;
        k->bounce = hits ? -along*v->body->restitution : 0;
    }
}

void tobi_contact_aim(tobi_contacts *c, const tobi_body *b, const tobi_contact_step *step, tobi_exec *x)
{
    const visiting view = { .c = c, .body = &b->rigid, .step = step };
    tobi_loop(c->count > TOBI_BLOCK ? x->threads : 1, c->count, 0, aim_contacts, &view);
}

/* By how much the velocity must change along the normal, if at all. */
static double find_lack(const tobi_contact *k, double along, double dt)
{
    double allowed = k->bounce > 0 ? k->bounce : -larger(k->gap, 0)/dt;
    return allowed - along;
}

/* The impulse of a contact for given velocities of the body: into change. pace: 1 or PACE. */
static void find_change(tobi_contact *k, const tobi_contacts *c, double friction, double dt, double pace)
{
    double relative[3], wanted[3], normal, slide[3];
    find_relative(k, c->velocity, c->spin, relative);
    double along = vec3_dot(relative, k->normal), lack = find_lack(k, along, dt);
    normal = larger(0, vec3_dot(k->impulse, k->normal) + lack*pace/k->mobility[0]);
    for (int a = 0; a < 3; a++) {
        double sliding = relative[a] - along*k->normal[a];
        wanted[a] = k->impulse[a] - sliding*pace/k->mobility[1];
    }
    vec3_add_scaled(slide, wanted, -vec3_dot(wanted, k->normal), k->normal);
    double size = vec3_length(slide), limit = friction*normal;
    k->sliding = size > limit;
    const double keep = k->sliding ? limit/size : 1;
    for (int a = 0; a < 3; a++) k->change[a] = normal*k->normal[a] + keep*slide[a] - k->impulse[a];
}

/* The same of an edge: it holds the material within the plane of the cut as long as the force, which then
   points where the edge goes, is not enough to cut. */
static void find_edge_change(tobi_contact *k, const tobi_contacts *c, double pace)
{
    double relative[3], wanted[3];
    find_relative(k, c->velocity, c->spin, relative);
    vec3_add_scaled(relative, relative, -vec3_dot(relative, k->normal), k->normal);
    vec3_add_scaled(wanted, k->impulse, -pace/k->mobility[1], relative);
    double size = vec3_length(wanted);
    double most = size > 0 ? k->limit*larger(0, vec3_dot(wanted, k->ahead)/size) : 0;
    k->sliding = size > most;
    for (int a = 0; a < 3; a++)
        k->change[a] = (k->sliding && size > 0 ? wanted[a]*most/size : wanted[a]) - k->impulse[a];
}

/* The impulses that the sweeps start from: along normals those of the last step, in change as they were
   listed; with them what friction makes of the sliding before. */
static void find_start(tobi_contact *k, const tobi_contacts *c, double friction)
{
    const double normal = vec3_dot(k->change, k->normal), limit = friction*normal;
    double relative[3], slide[3];
    if (!(normal > 0)) return;
    find_relative(k, c->velocity, c->spin, relative);
    vec3_add_scaled(slide, relative, -vec3_dot(relative, k->normal), k->normal);
    const double size = vec3_length(slide)/k->mobility[1];
    vec3_add_scaled(k->change, k->change, -(size > limit ? limit/size : 1)/k->mobility[1], slide);
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
    if (edge ? !stick : vec3_dot(k->impulse, k->normal) + lack/k->mobility[0] <= 0) return;
    double allowed = k->bounce > 0 || edge ? k->bounce : -larger(k->gap, 0)/dt;
    const double along = edge ? 0 : 1/k->mobility[0], across = stick ? 1/k->mobility[1] : 0;
    for (int r = 0; r < 3; r++)
        for (int n = 0; n < 3; n++)
            p[r][n] = (along - across)*k->normal[r]*k->normal[n] + (r == n ? across : 0);
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
void tobi_contact_eliminate(double a[6][6], double b[6])
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

static void sum_parts(const void *view, int64_t begin, int64_t end)
{
    const visiting *v = view;
    const tobi_contacts *c = v->c;
    for (int64_t q = begin; q < end; q++) {
        double *sum = c->partial + q*SUMS;
        memset(sum, 0, (size_t)v->width*sizeof *sum);
        for (int64_t n = q*TOBI_BLOCK; n < (q + 1)*TOBI_BLOCK && n < c->count; n++) {
            const tobi_contact *k = &c->list[n];
            double twist[3];
            if (v->width == SUMS) {
                add_contact(k, c, v->dt, sum);
                continue;
            }
            vec3_cross(twist, k->arm, k->change);
            for (int a = 0; a < 3; a++) { sum[a] += k->change[a]; sum[3 + a] += twist[a]; }
        }
    }
}

/* Sums `width` numbers per contact over the list, in one order for any number of threads. */
static void sum_contacts(tobi_contacts *c, int width, double dt, double *total, tobi_exec *x)
{
    const int64_t parts = count_parts(c);
    const visiting view = { .c = c, .width = width, .dt = dt };
    memset(total, 0, (size_t)width*sizeof *total);
    tobi_loop(x->threads, parts, 1, sum_parts, &view);
    for (int64_t q = 0; q < parts; q++)
        for (int n = 0; n < width; n++) total[n] += c->partial[q*SUMS + n];
}

/* The predicted velocities after the impulses of this sweep, solved with them: V = V0 + M^-1 (r - K V). */
static void predict(tobi_contacts *c, double dt, tobi_exec *x)
{
    double total[SUMS], a[6][6], b[6], (*inverse)[6] = c->inverse;
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
    tobi_contact_eliminate(a, b);
    memcpy(c->velocity, b, sizeof c->velocity);
    memcpy(c->spin, b + 3, sizeof c->spin);
}

/* One sweep over parts of the list; of each the largest squares of change and impulse into partial. */
static void sweep_parts(const void *view, int64_t begin, int64_t end)
{
    const visiting *v = view;
    tobi_contacts *c = v->c;
    for (int64_t q = begin; q < end; q++) {
        double most = 0, largest = 0;
        for (int64_t n = q*TOBI_BLOCK; n < (q + 1)*TOBI_BLOCK && n < c->count; n++) {
            tobi_contact *k = &c->list[n];
            if (v->first && k->particle >= 0 && !v->moves) find_start(k, c, v->body->friction);
            if (!v->first && k->particle < 0) find_edge_change(k, c, v->pace);
            else if (!v->first) find_change(k, c, v->body->friction, v->dt, v->pace);
            for (int a = 0; a < 3; a++) k->impulse[a] += k->change[a];
            most = larger(most, vec3_dot(k->change, k->change));
            largest = larger(largest, vec3_dot(k->impulse, k->impulse));
        }
        c->partial[q*SUMS] = most;
        c->partial[q*SUMS + 1] = largest;
    }
}

double tobi_contact_sweep(tobi_contacts *c, tobi_body *b, const tobi_contact_step *step, int first,
                          tobi_exec *x)
{
    const tobi_rigid *r = &b->rigid;
    double most = 0, largest = 0;
    int moves = r->kind != TOBI_PRESCRIBED;
    const double pace = moves ? 1 : PACE;
    double velocity[3], spin[3], total[6];
    memcpy(velocity, c->velocity, sizeof velocity);
    memcpy(spin, c->spin, sizeof spin);
    if (moves && !first) predict(c, step->dt, x);
    const visiting view = { .c = c, .body = r, .dt = step->dt, .first = first, .moves = moves, .pace = pace };
    tobi_loop(x->threads, count_parts(c), 1, sweep_parts, &view);
    for (int64_t q = 0; q < count_parts(c); q++) {
        most = larger(most, c->partial[q*SUMS]);
        largest = larger(largest, c->partial[q*SUMS + 1]);
    }
    const double moved = most > 0 ? sqrt(most/larger(largest, 1e-300)) : 0;
    if (!moves) return moved;
    /* What the impulses really were. */
    double (*inverse)[6] = c->inverse;
    sum_contacts(c, 6, step->dt, total, x);
    for (int a = 0; a < 3; a++) {
        c->velocity[a] = velocity[a] - vec3_dot(inverse[a], total) - vec3_dot(inverse[a] + 3, total + 3);
        c->spin[a] = spin[a] - vec3_dot(inverse[3 + a], total) - vec3_dot(inverse[3 + a] + 3, total + 3);
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

/* What the contacts of a body give it and cost in a step. */
typedef union outcome {
    struct {
        double pressure[6], friction[6];   /* N s, and N m s about its centre: along normals, surfaces */
        double edge[3], edge_limit;        /* N s, of the edge's pieces, and what they may be at most  */
        double pushing;                    /* contacts                                                 */
        double fracture, rubbing, material;    /* J, taken by each; on the material by its velocity    */
        double mass;                       /* kg, of the material that answers                         */
        double shape;                      /* J, on the body, by its change of shape                   */
    };
    double all[22];
} outcome;
_Static_assert(sizeof(outcome) == 22*sizeof(double), "the struct and its array are the same numbers");
_Static_assert(sizeof(outcome) <= SUMS*sizeof(double), "fits its place in partial");

static void add_impulse(const tobi_contact *k, const tobi_contacts *c, outcome *sum)
{
    const int edge = k->particle < 0;
    double part[2][3], twist[3], relative[3], normal = vec3_dot(k->impulse, k->normal);
    for (int a = 0; a < 3; a++) {
        part[0][a] = edge ? -k->impulse[a] : -normal*k->normal[a];
        part[1][a] = -k->impulse[a] - part[0][a];
    }
    for (int m = 0; m < 2; m++) {
        double *to = m ? sum->friction : sum->pressure;
        vec3_cross(twist, k->arm, part[m]);
        for (int a = 0; a < 3; a++) { to[a] += part[m][a]; to[3 + a] += twist[a]; }
    }
    find_relative(k, c->velocity, c->spin, relative);
    *(edge ? &sum->fracture : &sum->rubbing) -= vec3_dot(k->impulse, relative);
    sum->material += vec3_dot(k->impulse, k->velocity);
    sum->shape -= vec3_dot(k->impulse, k->deforming);
    if (!edge && normal > 0) sum->mass += 1/k->mobility[0];
    sum->pushing += edge ? vec3_dot(k->impulse, k->impulse) > 0 : normal > 0;
    if (!edge) return;
    for (int a = 0; a < 3; a++) sum->edge[a] -= k->impulse[a];
    sum->edge_limit += k->limit;
}

static void sum_outcomes(const void *view, int64_t begin, int64_t end)
{
    const visiting *v = view;
    const tobi_contacts *c = v->c;
    for (int64_t q = begin; q < end; q++) {
        outcome sum;
        memset(&sum, 0, sizeof sum);
        for (int64_t n = q*TOBI_BLOCK; n < (q + 1)*TOBI_BLOCK && n < c->count; n++) {
            const tobi_contact *k = &c->list[n];
            add_impulse(k, c, &sum);
            if (k->particle >= 0)
                v->particles->velocity[k->particle].w = (float)(vec3_dot(k->impulse, k->normal)/v->dt);
        }
        memcpy(c->partial + q*SUMS, sum.all, sizeof sum);
    }
}

/* Sums over the list, in one order for any number of threads; particles remember their normal forces. */
static void sum_impulses(tobi_contacts *c, tobi_particles *p, double dt, outcome *total, tobi_exec *x)
{
    const int64_t parts = count_parts(c);
    const visiting view = { .c = c, .dt = dt, .particles = p };
    memset(total, 0, sizeof *total);
    tobi_loop(x->threads, parts, 1, sum_outcomes, &view);
    for (int64_t q = 0; q < parts; q++)
        for (size_t n = 0; n < sizeof *total/sizeof *total->all; n++) total->all[n] += c->partial[q*SUMS + n];
}

static void list_shifts(tobi_contacts *c, const tobi_contact_step *step, double *far)
{
    for (int64_t n = 0; n < c->count; n++) {
        const tobi_contact *k = &c->list[n];
        if (!(k->gap < 0) || k->particle < 0) continue;
        const double push = find_push(k, step);
        tobi_shift *shift = &c->shift[c->shift_count++];
        *shift = (tobi_shift){ .particle = k->particle };
        for (int a = 0; a < step->dimension; a++) shift->by[a] = push*k->normal[a];
        *far = larger(*far, push);
    }
}

/* A resting contact answers what has brought the two together: the body's pull, given after the last step and
   over its length, and the material's stress, over this one; each counts as the other's mass lets it. */
static double find_span(const tobi_body *b, const outcome *total, const tobi_contact_step *step)
{
    double share = b->rigid.mass/(b->rigid.mass + total->mass);
    return step->before > 0 ? share*step->dt + (1 - share)*step->before : step->dt;
}

static void give_to_body(tobi_body *b, const outcome *total, const tobi_contact_step *step)
{
    tobi_body_load *load = &b->load[step->system];
    for (int a = 0; a < 3; a++) {
        b->rigid.impulse[a] += total->pressure[a] + total->friction[a];
        b->rigid.twist[a] += total->pressure[3 + a] + total->friction[3 + a];
        load->edge[a] += total->edge[a]/step->whole;
    }
    load->shape += total->shape/step->whole;
    for (int a = 0; a < 6; a++) {
        load->pressure[a] += total->pressure[a]/step->whole;
        load->friction[a] += total->friction[a]/step->whole;
    }
}

static void remember_edge(const tobi_contacts *c, tobi_body *b, const outcome *total)
{
    const double limit = total->edge_limit;
    for (int64_t n = 0; n < b->piece_count; n++)
        for (int a = 0; a < 3; a++) b->edge_share[n][a] = limit > 0 ? -total->edge[a]/limit : 0;
    for (int64_t n = c->count - 1; n >= 0 && c->list[n].particle < 0; n--)
        for (int a = 0; a < 3; a++)
            b->edge_share[-1 - c->list[n].particle][a] = c->list[n].impulse[a]/c->list[n].limit;
}

int64_t tobi_contact_finish(tobi_contacts *c, tobi_particles *p, tobi_body *b, const tobi_contact_step *step,
                            double *far, tobi_contact_work *work, tobi_exec *x)
{
    outcome total;
    sum_impulses(c, p, step->dt, &total, x);
    list_shifts(c, step, far);
    work->fracture += total.fracture;
    work->friction += total.rubbing;
    work->bodies += total.fracture + total.rubbing + total.material;
    give_to_body(b, &total, step);
    remember_edge(c, b, &total);
    b->rigid.span = find_span(b, &total, step);
    /* Touched, it moves as it will, or a resting body would fall into the material in every step. */
    if (b->rigid.kind != TOBI_PRESCRIBED && total.pushing > 0)
        tobi_body_correct(b, c->velocity, c->spin, step->dt);
    return (int64_t)total.pushing;
}
