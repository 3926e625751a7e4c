/* Nests in pictures: in their boxes the liquid of nests is shown, outside of them the scene's. Drawback: the
   particles of both are kept where only one is shown. */
#include "tobiuo/drawing.h"
#include "tobiuo/tobiuo.h"
#include "view/draw.h"
#include "view/drawing.h"
#include <stdlib.h>
#include <string.h>

/* m: how far a place lies outside of a box; below 0: inside. */
static double find_outside(const double box[2][3], const double x[3])
{
    double out = -INFINITY;
    for (int a = 0; a < 3; a++) out = fmax(out, fmax(box[0][a] - x[a], x[a] - box[1][a]));
    return out;
}

/* Where boxes overlap, the first counts. */
double view_beyond_nests(const double (*boxes)[2][3], int count, int nest, const double x[3])
{
    double beyond = nest > 0 && nest <= count ? find_outside(boxes[nest - 1], x) : -INFINITY;
    for (int k = 0; k < (nest > 0 ? nest - 1 : count); k++)
        beyond = fmax(beyond, -find_outside(boxes[k], x));
    return beyond;
}

int tobi_moment_shows(const tobi_moment *m, int64_t i)
{
    if (!m || i < 0 || i >= m->count) return 0;
    return view_beyond_nests((const double (*)[2][3])m->nests, m->nest_count, view_moment_nest(m, i),
                             m->positions[i]) <= 0;
}

/* Of the box around the surface of a body; false: the moment has none. */
static bool find_middle(const tobi_looks *looks, int body, const tobi_moment *m, double middle[3])
{
    for (int k = 0; k < m->surface_count; k++) {
        const tobi_moment_surface *s = &m->surfaces[k];
        double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
        if (s->vertex_count == 0 || tobi_drawing_find_body(looks, s->name) != body) continue;
        for (int64_t i = 0; i < s->vertex_count; i++)
            for (int a = 0; a < 3; a++) {
                low[a] = fmin(low[a], s->vertices[i][a]);
                high[a] = fmax(high[a], s->vertices[i][a]);
            }
        for (int a = 0; a < 3; a++) middle[a] = 0.5*(low[a] + high[a]);
        return true;
    }
    return false;
}

int tobi_nest_box(const tobi_looks *looks, const tobi_nest_def *nest, const tobi_moment *moment,
                  double box[2][3])
{
    double way[3] = { 0, 0, 0 }, middle[3], domain[2][3];
    if (!looks || !nest || !moment || !box) return 0;
    const int body = tobi_drawing_find_body(looks, nest->follow);
    if (nest->follow && (body < 0 || !find_middle(looks, body, moment, middle))) return 0;
    for (int a = 0; a < 3; a++) {
        if (nest->follow) way[a] = middle[a] - looks->bodies[body].middle[a];
        box[0][a] = nest->box_min[a] + way[a];
        box[1][a] = nest->box_max[a] + way[a];
        domain[0][a] = looks->box_min[a];
        domain[1][a] = looks->box_max[a];
    }
    const double rim = looks->rim/(looks->is_nest ? 1 : nest->refinement);
    tobi_nest_open_sides(box, (const double (*)[3])domain, rim, looks->dimension);
    return 1;
}

typedef struct joining {
    tobi_moment *to;
    const tobi_moment *from;
    int64_t *row, count;         /* of the particles that are taken */
} joining;

static bool find_rows(joining *j, const double box[2][3], double spacing)
{
    j->row = malloc(((size_t)j->from->count + 1)*sizeof *j->row);
    for (int64_t i = 0; j->row && i < j->from->count; i++)
        if (find_outside(box, j->from->positions[i]) <= VIEW_NEST_MARGIN*spacing) j->row[j->count++] = i;
    return j->row != NULL;
}

/* Values behind those that are there, each of so many numbers; of what the nest lacks not a number. */
static bool append(const joining *j, double **values, const double *from, int components)
{
    const int64_t before = j->to->count;
    double *all = realloc(*values, ((size_t)((before + j->count)*components) + 1)*sizeof *all);
    if (!all) return false;
    *values = all;
    for (int64_t k = 0; k < j->count; k++)
        for (int c = 0; c < components; c++)
            all[(before + k)*components + c] = from ? from[j->row[k]*components + c] : NAN;
    return true;
}

static const double *values_of(const tobi_moment *m, const tobi_moment_field *like)
{
    for (int k = 0; k < m->field_count; k++)
        if (strcmp(m->fields[k].name, like->name) == 0 && m->fields[k].components == like->components)
            return m->fields[k].values;
    return NULL;
}

static bool join(joining *j)
{
    tobi_moment *m = j->to;
    const size_t n = (size_t)(m->count + j->count);
    uint8_t *nest = realloc(m->nest, n + 1);
    if (!nest) return false;
    if (!m->nest) memset(nest, 0, n + 1);
    m->nest = nest;
    memset(nest + m->count, 1 + m->nest_count, (size_t)j->count);
    double *place = m->positions ? m->positions[0] : NULL;
    const bool placed = append(j, &place, j->from->positions ? j->from->positions[0] : NULL, 3);
    m->positions = (double (*)[3])(void *)place;
    bool enough = placed;
    for (int k = 0; enough && k < m->field_count; k++) {
        tobi_moment_field *f = &m->fields[k];
        enough = append(j, &f->values, values_of(j->from, f), f->components);
    }
    return enough;
}

tobi_status tobi_moment_add_nest(tobi_moment *moment, const tobi_moment *nest, const double box[2][3],
                                 double spacing, tobi_error *err)
{
    TOBI_NEED(moment, "the moment");
    TOBI_NEED(nest, "the moment of the nest");
    TOBI_NEED(box, "the box of the nest");
    if (moment->nest_count == TOBI_NEST_LIMIT)
        return tobi_fail(err, TOBI_INVALID, "a moment has %d nests or fewer", TOBI_NEST_LIMIT);
    if (!(spacing > 0)) return tobi_fail(err, TOBI_INVALID, "a nest with a spacing of %g m", spacing);
    joining j = { .to = moment, .from = nest };
    const bool enough = find_rows(&j, box, spacing) && join(&j);
    free(j.row);
    if (!enough) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    memcpy(moment->nests[moment->nest_count], box, sizeof moment->nests[0]);
    moment->nest_spacing[moment->nest_count++] = spacing;
    moment->count += j.count;
    return TOBI_OK;
}
