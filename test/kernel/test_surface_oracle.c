/* The kernels of surfaces against all pairs in double: what is around each particle, the level set at each
   node, the means at vertices. Walls and groups too. */
#include "unit/calls.h"
#include "unit/surface_rig.h"
#include "view/surface/surface.h"

#define D 0.01

typedef struct rig {
    rig_points p;
    int32_t *group;
    tobi_surface_field field;
    surface_work w;
    tobi_surface_def d;
} rig;

static void setup(rig *r, double jitter)
{
    *r = (rig){ .p = rig_box((int[3]){ 9, 8, 7 }, (double[3]){ 5, -3, 0 }, D, jitter) };
    r->group = malloc((size_t)r->p.count*sizeof *r->group);
    for (int64_t i = 0; i < r->p.count; i++) r->group[i] = r->p.position[i][0] > 5.03 ? 2 : 0;
    r->field = (tobi_surface_field){ "place", 3, &r->p.position[0][0] };
    r->d = tobi_default_surface();
    r->d.particle_count = r->p.count;
    r->d.positions = (const double (*)[3])r->p.position;
    r->d.group = r->group;
    r->d.fields = &r->field, r->d.field_count = 1;
    r->d.spacing = D, r->d.threads = 2;
    r->d.box_min[2] = 0, r->d.box_max[2] = 1, r->d.flat_min[2] = 1;
    r->w.def = &r->d;
    OK(tobi_exec_init(&r->w.exec, 2, &err));
    OK(tobi_exec_reserve(&r->w.exec, 100000, &err));
    OK(surface_place_points(&r->w, &err));
    OK(surface_list_blocks(&r->w, &err));
}

static int32_t group_of(const rig *r, int64_t point)
{
    const int32_t i = r->w.of[point];
    return r->group[i < 0 ? -1 - i : i];
}

static double kernel(const rig *r, int64_t k, const double at[3])
{
    const double x = r->w.x[k] - at[0], y = r->w.y[k] - at[1], z = r->w.z[k] - at[2], t = 1 - x*x - y*y - z*z;
    return t > 0 ? t*t*t : 0;
}

static void expect(double value, double wanted)
{
    if (!(fabs(value - wanted) <= 2e-5*(1 + fabs(wanted)))) fail_msg("%.9g instead of %.9g", value, wanted);
}

static void check_counts(const rig *r)
{
    for (int64_t i = 0; i < r->w.points; i++) {
        double sum = 0;
        const double at[3] = { r->w.x[i], r->w.y[i], r->w.z[i] };
        for (int64_t k = 0; k < r->w.points; k++)
            if (group_of(r, k) == group_of(r, i)) sum += kernel(r, k, at);
        expect(r->w.count[i], sum);
        if (sum >= r->w.view.dense*1.001) expect(r->w.strength[i],
                                                   r->w.view.scale*pow(r->w.view.scale*sum, -0.75));
    }
}

static void check_nodes(const rig *r)
{
    const surface_view *v = &r->w.view;
    int64_t inside = 0;
    for (int64_t b = 0; b < v->block_count; b++) {
        int32_t place[3];
        const int32_t group = (int32_t)surface_place(v, b, place);
        for (int n = 0; n < SURFACE_NODES; n++) {
            const int at[3] = { n%8, n/8%8, n/64 };
            double p[3], sum = -v->level;
            for (int a = 0; a < 3; a++) p[a] = (place[a]*8 + at[a])*(double)v->cell[a];
            for (int64_t k = 0; k < r->w.points; k++)
                if (group_of(r, k) == group) sum += r->w.strength[k]*kernel(r, k, p);
            expect(r->w.node[b*SURFACE_NODES + n], place[2]*8 + at[2] < v->low[2] ? -1 : sum);
            inside += sum > 0;
        }
    }
    assert_true(inside > 500);
}

/* Vertices of the cubes, before short edges are merged. */
static void check_means(rig *r)
{
    surface_work *w = &r->w;
    OK(surface_find_drops(w, &err));
    OK(surface_march(w, &err));
    OK(surface_take_values(w, &err));
    assert_true(w->vertices > 300);
    for (int64_t i = 0; i < w->vertices; i++) {
        const double p[3] = { w->vertex[i].x, w->vertex[i].y, w->vertex[i].z };
        int32_t place[3];
        const int32_t group = (int32_t)surface_place(&w->view, w->block_of[i], place);
        double sum = 0, mean[3] = { 0 };
        for (int64_t k = 0; k < w->points; k++) {
            const double part = group_of(r, k) == group ? w->strength[k]*kernel(r, k, p) : 0;
            sum += part;
            const int32_t of = w->of[k] < 0 ? -1 - w->of[k] : w->of[k];
            for (int a = 0; a < 3; a++) mean[a] += part*r->p.position[of][a];
        }
        for (int a = 0; a < 3; a++) expect(w->fields[0][3*i + a], mean[a]/sum);
    }
}

static void tear_down(rig *r)
{
    surface_free_work(&r->w);
    free(r->group);
    free(r->p.position);
}

static void test_all_pairs(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        rig r;
        setup(&r, k ? 2 : 0.3);
        check_counts(&r);
        check_nodes(&r);
        check_means(&r);
        tear_down(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_all_pairs) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
