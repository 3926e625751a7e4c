/* In 2-D: how much of the cell around each node of a grid lies in bodies and solids. Closed lines are added
   up as areas to their right, exactly, then summed along each row. Drawback: where two bodies that overlap
   end in one cell, it counts for both, up to all of it. */
#include "view/draw.h"
#include <string.h>

/* A line within a row, from a to b, in cells; `down` is how far it goes down. */
static void add_piece(float *row, int across, float a, float b, float down)
{
    a = clampf(a, 0, (float)across), b = clampf(b, 0, (float)across);
    const float low = a < b ? a : b, high = a < b ? b : a;
    const int first = (int)low, last = (int)high;
    for (int c = first; c <= last && c < across; c++) {
        const float from = c > first ? (float)c : low, to = c < last ? (float)c + 1 : high;
        const float part = first == last ? down : down*(to - from)/(high - low);
        const float right = (float)c + 1 - 0.5f*(from + to);
        row[c] += part*right;
        if (c + 1 < across) row[c + 1] += part*(1 - right);
    }
}

static void add_line(const cover_grid *g, const vec end[2], float *out)
{
    float x[2], y[2];      /* cells */
    for (int k = 0; k < 2; k++) {
        x[k] = (end[k].x - g->low[0])/g->edge + 0.5f;
        y[k] = (end[k].y - g->low[1])/g->edge + 0.5f;
    }
    const float top = (float)g->size[1];
    if (y[0] == y[1] || !(fabsf(x[0]) + fabsf(x[1]) + fabsf(y[0]) + fabsf(y[1]) < 1e9f)) return;
    const int first = (int)clampf(fminf(y[0], y[1]), 0, top), last = (int)clampf(fmaxf(y[0], y[1]), 0, top);
    for (int r = first; r <= last && r < g->size[1]; r++) {
        const float from = clampf(y[0], (float)r, (float)r + 1), to = clampf(y[1], (float)r, (float)r + 1);
        const float begin = (from - y[0])/(y[1] - y[0]), end_at = (to - y[0])/(y[1] - y[0]);
        add_piece(out + (int64_t)r*g->size[0], g->size[0], x[0] + begin*(x[1] - x[0]),
                  x[0] + end_at*(x[1] - x[0]), from - to);
    }
}

void view_cover_nodes(const cover_grid *g, const segments *lines, int lists, float *out)
{
    memset(out, 0, (size_t)g->size[0]*(size_t)g->size[1]*sizeof *out);
    for (int l = 0; l < lists; l++)
        for (int64_t k = 0; k < lines[l].count; k++) add_line(g, lines[l].end[k], out);
    for (int y = 0; y < g->size[1]; y++) {
        float *row = out + (int64_t)y*g->size[0], sum = 0;
        for (int x = 0; x < g->size[0]; x++) {
            sum += row[x];
            row[x] = fminf(fabsf(sum), 1);
        }
    }
}

bool view_add_section(segments *out, const canvas *c, const tobi_picture_mesh *m)
{
    const int64_t begin = out->count;
    vec sum = { 0, 0, 0 };
    float length = 0;
    for (int64_t t = 0; t < m->triangle_count; t++) {
        double end[2][3];
        if (!view_cross_triangle(m, m->triangles[t], end)) continue;
        const vec a = view_point(&c->camera, end[0]), b = view_point(&c->camera, end[1]);
        if (!view_add_segment(out, a, b)) return false;
        sum = vec_add(sum, vec_sub(b, a));
        length += fabsf(b.x - a.x) + fabsf(b.y - a.y);
    }
    if (!(fabsf(sum.x) + fabsf(sum.y) <= 1e-3f*length)) out->count = begin;      /* it is open */
    return true;
}
