/* Whether a mesh is a box, or a box with one box taken out: then water and walls need no mesh. Decided by the
   coordinates of its vertices and its exact volume. Drawback: a box of many small facets is not found when a
   vertex lies off its edges and faces. */
#include "scene/import/tank.h"
#include "geom/massprops.h"
#include "geom/mesh.h"
#include <math.h>

enum { MOST = 4 };

/* Sorted coordinates along an axis that no two vertices share within tiny; -1 above MOST. */
static int list_levels(const tobi_mesh *mesh, int axis, double tiny, double level[MOST])
{
    int count = 0;
    for (int64_t i = 0; i < mesh->vertex_count; i++) {
        const double x = mesh->vertices[i][axis];
        int k = 0;
        while (k < count && level[k] < x - tiny) k++;
        if (k < count && fabs(level[k] - x) <= tiny) continue;
        if (count == MOST) return -1;
        for (int j = count++; j > k; j--) level[j] = level[j - 1];
        level[k] = x;
    }
    return count;
}

static double volume_of(const double low[3], const double high[3])
{
    return (high[0] - low[0])*(high[1] - low[1])*(high[2] - low[2]);
}

/* The cavity lies inside of the walls; it may reach the top. */
static int find_cavity(const tobi_mesh *mesh, double tiny, double volume, tobi_tank_shape *s)
{
    double level[MOST];
    for (int a = 0; a < 3; a++) {
        const int count = list_levels(mesh, a, tiny, level);
        s->open = a == 2 && count == 3;
        if (count != 4 && !s->open) return 0;
        s->cavity_low[a] = level[1];
        s->cavity_high[a] = level[2];
    }
    const double wall = volume_of(s->low, s->high) - volume_of(s->cavity_low, s->cavity_high);
    return fabs(volume - wall) < 1e-6*wall;
}

static void find_shape(const tobi_mesh *mesh, double volume, tobi_tank_shape *s)
{
    double size = 0;
    tobi_mesh_box(mesh, s->low, s->high);
    for (int a = 0; a < 3; a++) size = fmax(size, s->high[a] - s->low[a]);
    s->box = fabs(volume - volume_of(s->low, s->high)) < 1e-6*volume;
    s->tank = !s->box && find_cavity(mesh, 1e-6*size, volume, s);
}

tobi_status tobi_tank_look(const char *file, tobi_tank_shape *shape, tobi_error *err)
{
    tobi_mesh mesh = { 0 };
    tobi_massprops props = { 0 };
    *shape = (tobi_tank_shape){ 0 };
    tobi_status status = tobi_mesh_read(file, &mesh, err);
    if (status == TOBI_OK) status = tobi_mesh_orient(&mesh, file, err);
    if (status == TOBI_OK) status = tobi_massprops_volume(&mesh, &props, err);
    if (status == TOBI_OK) find_shape(&mesh, props.volume, shape);
    tobi_mesh_free(&mesh);
    return status;
}
