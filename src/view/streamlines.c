/* Streamlines of liquids: evenly spaced (Jobard and Lefer 1997), by Runge-Kutta steps in the mean velocity of
   the particles around. With a clip plane they lie in it. Drawback: seeds are tried one after the other, on
   one thread, so that lines do not depend on the number of threads. */
#include "view/streamlines.h"
#include "view/weight.h"
#include <stdlib.h>
#include <string.h>

enum { MOST_STEPS = 4000, MOST_BINS = 1 << 22 };
static const double STEP = 0.4;          /* spacings                                       */
static const double SLOW = 1e-3;         /* of the largest speed: nothing moves            */
static const double THIN = 0.6;          /* of full liquid: it ends                        */

/* Points in bins of an edge. */
typedef struct bins {
    double low[3], edge;
    int size[3];
    int32_t *head, *next;        /* the first of a bin, and the next of a point; -1: none  */
} bins;

typedef struct tracer {
    const tobi_picture *f;
    int dimension;
    double spacing, apart, fastest;
    double normal[3], point[3];  /* of the plane                                           */
    bool flat;                   /* lines lie in the plane                                 */
    bins particles, lines;
    int64_t next_room;
    stream_lines *out;
} tracer;

static int bin_of(const bins *b, const double x[3])
{
    int at[3];
    for (int a = 0; a < 3; a++) {
        const double place = (x[a] - b->low[a])/b->edge;
        at[a] = place < 0 ? 0 : place >= b->size[a] ? b->size[a] - 1 : (int)place;
    }
    return (at[2]*b->size[1] + at[1])*b->size[0] + at[0];
}

static bool make_bins(bins *b, const tobi_picture *f, double edge)
{
    double count = INFINITY;
    for (b->edge = edge; count > MOST_BINS; b->edge *= 1.5) {
        count = 1;
        for (int a = 0; a < 3; a++) {
            const double extent = a < f->dimension ? f->box_max[a] - f->box_min[a] : 0;
            b->low[a] = a < f->dimension ? f->box_min[a] : 0;
            b->size[a] = (int)fmin(1e6, extent/b->edge) + 1;
            count *= b->size[a];
        }
        if (count <= MOST_BINS) break;
    }
    b->head = malloc((size_t)count*sizeof *b->head);
    if (b->head) memset(b->head, -1, (size_t)count*sizeof *b->head);
    return b->head != NULL;
}

/* Calls for each point of the bins around x; stops when it returns true, and tells so. */
typedef bool (*visit_fn)(void *user, int32_t i);
static bool visit(const bins *b, int dimension, const double x[3], visit_fn fn, void *user)
{
    int at[3];
    for (int a = 0; a < 3; a++) {
        const double place = (x[a] - b->low[a])/b->edge;
        at[a] = place < 0 ? -1 : place >= b->size[a] ? b->size[a] : (int)place;
    }
    for (int k = 0; k < (dimension == 3 ? 27 : 9); k++) {
        const int p[3] = { at[0] + k%3 - 1, at[1] + k/3%3 - 1, dimension == 3 ? at[2] + k/9 - 1 : 0 };
        int inside = 1;
        for (int a = 0; a < 3; a++) inside &= p[a] >= 0 && p[a] < b->size[a];
        if (!inside) continue;
        for (int32_t i = b->head[(p[2]*b->size[1] + p[1])*b->size[0] + p[0]]; i >= 0; i = b->next[i])
            if (fn(user, i)) return true;
    }
    return false;
}

static double distance2(const double a[3], const double b[3], int dimension)
{
    double sum = 0;
    for (int k = 0; k < dimension; k++) sum += (a[k] - b[k])*(a[k] - b[k]);
    return sum;
}

typedef struct mean { const tracer *t; const double *x; double weight, v[3]; } mean;

static bool add_particle(void *user, int32_t i)
{
    mean *m = user;
    const tracer *t = m->t;
    const double reach2 = 4*t->spacing*t->spacing;
    const double r2 = distance2(m->x, t->f->positions[i], t->dimension);
    if (!(r2 < reach2)) return false;
    const double w = view_weight(r2, reach2);
    m->weight += w;
    for (int a = 0; a < t->dimension; a++) m->v[a] += w*t->f->flow[i][a];
    return false;
}

/* The direction of the flow; false: there is none. */
static bool find_direction(const tracer *t, const double x[3], double out[3])
{
    mean m = { .t = t, .x = x };
    double along = 0, size = 0;
    for (int a = 0; a < t->dimension; a++)
        if (!(x[a] >= t->f->box_min[a] && x[a] <= t->f->box_max[a])) return false;
    visit(&t->particles, t->dimension, x, add_particle, &m);
    if (!(m.weight > THIN*view_full_weight(t->dimension))) return false;
    for (int a = 0; a < 3; a++) m.v[a] /= m.weight, along += m.v[a]*t->normal[a];
    for (int a = 0; a < 3; a++) {
        if (t->flat) m.v[a] -= along*t->normal[a];
        size += m.v[a]*m.v[a];
    }
    size = sqrt(size);
    if (!(size > SLOW*t->fastest)) return false;
    for (int a = 0; a < 3; a++) out[a] = m.v[a]/size;
    return true;
}

static void go(const double x[3], const double d[3], double s, double out[3])
{
    for (int a = 0; a < 3; a++) out[a] = x[a] + s*d[a];
}

/* One step of the method of fourth order along the direction, or against it. */
static bool take_step(const tracer *t, double x[3], double sign)
{
    const double s = sign*STEP*t->spacing;
    double k[4][3], y[3];
    if (!find_direction(t, x, k[0])) return false;
    go(x, k[0], 0.5*s, y);
    if (!find_direction(t, y, k[1])) return false;
    go(x, k[1], 0.5*s, y);
    if (!find_direction(t, y, k[2])) return false;
    go(x, k[2], s, y);
    if (!find_direction(t, y, k[3])) return false;
    for (int a = 0; a < 3; a++) x[a] += s*(k[0][a] + 2*k[1][a] + 2*k[2][a] + k[3][a])/6;
    return true;
}

typedef struct nearness { const tracer *t; const double *x; double least2; } nearness;

static bool is_near(void *user, int32_t i)
{
    const nearness *n = user;
    return distance2(n->x, n->t->out->point[i], n->t->dimension) < n->least2;
}

static bool is_near_line(const tracer *t, const double x[3], double least)
{
    nearness n = { t, x, least*least };
    return visit(&t->lines, t->dimension, x, is_near, &n);
}

/* Points from the seed on; *closed: it came back to it. */
static int follow(const tracer *t, const double seed[3], double sign, double (*to)[3], int room, bool *closed)
{
    const int own = (int)(2*t->apart/(STEP*t->spacing)) + 1;
    const double near2 = 0.25*t->apart*t->apart, step2 = STEP*STEP*t->spacing*t->spacing;
    double x[3];
    int n = 0;
    memcpy(x, seed, sizeof x);
    *closed = false;
    while (n < room && take_step(t, x, sign)) {
        if (n > 8 && distance2(x, seed, t->dimension) < step2) return *closed = true, n;
        if (is_near_line(t, x, 0.5*t->apart)) break;
        for (int k = own; k < n - own; k += 2)      /* beside its beginning it may be about to close */
            if (distance2(x, to[k], t->dimension) < near2) return n;
        memcpy(to[n++], x, sizeof x);
    }
    return n;
}

static bool reserve(tracer *t, int64_t more)
{
    stream_lines *o = t->out;
    if (o->count + more > t->next_room) {
        const int64_t room = 2*(o->count + more);
        double (*point)[3] = realloc(o->point, (size_t)room*sizeof *point);
        if (point) o->point = point;
        int32_t *next = realloc(t->lines.next, (size_t)room*sizeof *next);
        if (next) t->lines.next = next;
        if (!point || !next) return false;
        t->next_room = room;
    }
    int64_t *first = realloc(o->first, (size_t)(o->lines + 2)*sizeof *first);
    if (first) o->first = first;
    return first != NULL;
}

static void add_point(tracer *t, const double x[3])
{
    const int32_t i = (int32_t)t->out->count++;
    int32_t *head = &t->lines.head[bin_of(&t->lines, x)];
    memcpy(t->out->point[i], x, sizeof t->out->point[i]);
    t->lines.next[i] = *head;
    *head = i;
}

/* A line through a seed, unless it is short; room for 2 MOST_STEPS points. */
static bool add_line(tracer *t, const double seed[3], double (*room)[3])
{
    stream_lines *o = t->out;
    bool closed, unused;
    double (*back)[3] = room + MOST_STEPS;
    const int ahead = follow(t, seed, 1, room, MOST_STEPS, &closed);
    const int behind = closed ? 0 : follow(t, seed, -1, back, MOST_STEPS, &unused);
    if ((ahead + behind)*STEP*t->spacing < t->apart) return true;
    if (!reserve(t, ahead + behind + 2)) return false;
    o->first[o->lines++] = o->count;
    for (int k = behind - 1; k >= 0; k--) add_point(t, back[k]);
    add_point(t, seed);
    for (int k = 0; k < ahead; k++) add_point(t, room[k]);
    if (closed) add_point(t, seed);
    o->first[o->lines] = o->count;
    return true;
}

static bool is_shown(const tracer *t, int64_t i)
{
    const double *x = t->f->positions[i], *v = t->f->flow[i];
    double sum = 0;
    for (int a = 0; a < t->dimension; a++) sum += fabs(x[a]) + fabs(v[a]);
    return sum < INFINITY && !(t->f->opaque && t->f->opaque[i]) && view_is_in_nest(t->f, i);
}

static bool sort_particles(tracer *t)
{
    const tobi_picture *f = t->f;
    t->particles.next = malloc(((size_t)f->particle_count + 1)*sizeof *t->particles.next);
    if (!t->particles.next || !make_bins(&t->particles, f, 2*t->spacing)) return false;
    for (int64_t i = 0; i < f->particle_count; i++) {
        double size = 0;
        if (!is_shown(t, i)) continue;
        int32_t *head = &t->particles.head[bin_of(&t->particles, f->positions[i])];
        t->particles.next[i] = *head;
        *head = (int32_t)i;
        for (int a = 0; a < t->dimension; a++) size += f->flow[i][a]*f->flow[i][a];
        t->fastest = fmax(t->fastest, sqrt(size));
    }
    return true;
}

/* Moves a seed into the plane; false: it is too far from it. */
static bool put_in_plane(const tracer *t, double x[3])
{
    double off = 0;
    for (int a = 0; a < 3 && t->flat; a++) off += (x[a] - t->point[a])*t->normal[a];
    for (int a = 0; a < 3; a++) x[a] -= off*t->normal[a];
    return fabs(off) <= t->spacing;
}

static int64_t find_divisor(int64_t a, int64_t b)
{
    while (b) {
        const int64_t rest = a%b;
        a = b, b = rest;
    }
    return a;
}

/* Particles in an order that jumps through them all: neighbours are not tried one after the other. */
static bool try_seeds(tracer *t)
{
    const int64_t n = t->f->particle_count;
    double (*room)[3] = malloc(2*(size_t)MOST_STEPS*sizeof *room);
    int64_t stride = (int64_t)(0.6180339887*(double)n) + 1;
    bool enough = room != NULL;
    while (find_divisor(n, stride) > 1) stride++;
    for (int64_t k = 0, i = 0; enough && k < n; k++, i = (i + stride)%n) {
        double x[3] = { 0, 0, 0 };
        if (!is_shown(t, i)) continue;
        for (int a = 0; a < t->dimension; a++) x[a] = t->f->positions[i][a];
        if (put_in_plane(t, x) && !is_near_line(t, x, t->apart)) enough = add_line(t, x, room);
    }
    free(room);
    return enough;
}

bool view_trace_streamlines(const tobi_picture *f, stream_lines *out)
{
    tracer t = { .f = f, .dimension = f->dimension, .spacing = 2*f->radius, .out = out };
    double longest = 0, length = 0;
    *out = (stream_lines){ .count = 0 };
    for (int a = 0; a < f->dimension; a++) longest = fmax(longest, f->box_max[a] - f->box_min[a]);
    for (int a = 0; a < 3; a++) length += f->clip_normal[a]*f->clip_normal[a];
    t.flat = f->dimension == 3 && f->clip && length > 0;
    for (int a = 0; a < 3 && t.flat; a++)
        t.normal[a] = f->clip_normal[a]/sqrt(length), t.point[a] = f->clip_point[a];
    t.apart = fmax(longest/f->streamlines, 1.5*t.spacing);
    const bool enough = f->particle_count == 0 ||
        (sort_particles(&t) && make_bins(&t.lines, f, t.apart) && (t.fastest == 0 || try_seeds(&t)));
    free(t.particles.head);
    free(t.particles.next);
    free(t.lines.head);
    free(t.lines.next);
    if (!enough) view_free_streamlines(out);
    return enough;
}

void view_free_streamlines(stream_lines *s)
{
    free(s->point);
    free(s->first);
    *s = (stream_lines){ .count = 0 };
}

/* Out of the plane to the eye, so that what is cut there does not hide it. */
static vec lift(const canvas *c, const tobi_picture *f, vec p)
{
    if (!f->clip || f->dimension != 3) return p;
    const double off = (c->cut.faced ? 0.5*f->slice : 0) + 0.5*f->radius;
    const int side = c->cut.faced > 0 ? c->cut.faced - 1 : 0;
    return vec_add(p, vec_scale((float)off, c->cut.normal[side]));
}

/* Two strokes back from the middle of a line. */
static void draw_head(canvas *c, vec from, vec to, float size, float pen, vec color)
{
    const vec way = vec_unit(vec_sub(to, from)), across = vec_unit(vec_cross(way, to_eye(&c->camera, to)));
    for (int side = -1; side <= 1; side += 2) {
        const vec back = vec_add(vec_scale(-size, way), vec_scale(0.45f*size*(float)side, across));
        view_draw_line(c, to, vec_add(to, back), pen, color, 1, false);
    }
}

static void draw_lines(canvas *c, const tobi_picture *f, const stream_lines *s, float size, float pen,
                       vec color)
{
    for (int n = 0; n < s->lines; n++) {
        const int64_t first = s->first[n], last = s->first[n + 1] - 1, middle = (first + last)/2;
        vec before = lift(c, f, view_point(&c->camera, s->point[first]));
        for (int64_t k = first + 1; k <= last; k++) {
            const vec p = lift(c, f, view_point(&c->camera, s->point[k]));
            view_draw_line(c, before, p, pen, color, 1, false);
            if (k == middle) draw_head(c, before, p, size, pen, color);
            before = p;
        }
    }
}

/* On water pale; else dark with a pale rim, to be seen on any colour. */
bool view_draw_streamlines(canvas *c, const tobi_picture *f)
{
    stream_lines s;
    const bool water = f->dimension == 3 && f->look == TOBI_LOOK_NATURAL;
    const vec pale = { 0.95f, 0.97f, 1 }, rim = { 0.75f, 0.75f, 0.75f }, ink = { 0.01f, 0.01f, 0.02f };
    const float unit = view_letter_unit(c);
    double longest = 0;
    if (!view_trace_streamlines(f, &s)) return false;
    for (int a = 0; a < f->dimension; a++) longest = fmax(longest, f->box_max[a] - f->box_min[a]);
    const float size = (float)fmin(0.02*longest, 0.3*longest/f->streamlines);
    draw_lines(c, f, &s, size, water ? 1.1f*unit : 1.6f*unit, water ? pale : rim);
    if (!water) draw_lines(c, f, &s, size, 0.7f*unit, ink);
    view_free_streamlines(&s);
    return true;
}
