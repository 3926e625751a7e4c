/* The loops of a picture over samples of tiles and nodes of blocks, compiled once per instruction set. A
   tile is drawn by one thread, item by item, then its pixels are lit: each once where its samples see one
   surface, else for each surface. Drawback: light is computed pixel by pixel, not eight at once. */
#include "view/glass.h"
#include "view/image.h"
#include <stdlib.h>
#include <string.h>

#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)

/* The samples of a tile. */
typedef struct layer {
    float   nearness[MOST_SIDE*MOST_SIDE];
    int32_t item[MOST_SIDE*MOST_SIDE];      /* -1: nothing */
} layer;

static square tile_square(const canvas *c, const tiles *t, int64_t k)
{
    return (square){ .left = (float)((int)(k%t->across)*TILE), .top = (float)((int)(k/t->across)*TILE),
                     .side = TILE*c->samples, .step = 1/(float)c->samples };
}

/* The nearness of a plane of the cut at a point of the canvas. */
static float cut_nearness(const canvas *c, int plane, float x, float y)
{
    const vec n = c->cut.normal[plane];
    const float across = (x - c->camera.center_x)/c->camera.focal;
    const float up = (c->camera.center_y - y)/c->camera.focal;
    return (n.x*across + n.y*up + n.z)/c->cut.offset[plane];
}

/* Where the eye looks through a cut into a body, and sees a back face: the plane instead. Bodies that are
   filled were cut in the plane before the eye alone; what is beyond the other is left out here. */
static void fill_cuts(const canvas *c, const geometry *g, const square *q, layer *l)
{
    const int plane = c->cut.faced - 1;
    for (int y = 0, k = 0; y < q->side; y++)
        for (int x = 0; x < q->side; x++, k++) {
            face_setup f;
            if (l->item[k] < 0) continue;
            const int32_t *v = g->face[l->item[k]];
            const float px = q->left + ((float)x + 0.5f)*q->step, py = q->top + ((float)y + 0.5f)*q->step;
            if (set_up_face(&f, &g->at[v[0]], &g->at[v[1]], &g->at[v[2]]) && f.facing < 0) {
                const float near = cut_nearness(c, plane, px, py);
                l->nearness[k] = near > l->nearness[k] ? near : l->nearness[k];
            } else if (c->cut.count > 1 && l->nearness[k] < cut_nearness(c, 1 - plane, px, py)) {
                l->nearness[k] = -INFINITY, l->item[k] = -1;
            }
        }
}

static void draw_items(const painting *p, int64_t tile, const square *q, layer *l)
{
    const canvas *c = p->c;
    const geometry *g = p->g;
    bool filled = g->filled == 0 || !c->cut.faced;
    for (int64_t i = p->t->first[tile]; i < p->t->first[tile + 1]; i++) {
        const int32_t item = p->t->item[i];
        if (!filled && item >= g->filled) {
            fill_cuts(c, g, q, l);
            filled = true;
        }
        if (item < g->faces) {
            face_setup f;
            if (set_up_face(&f, &g->at[g->face[item][0]], &g->at[g->face[item][1]], &g->at[g->face[item][2]]))
                fill_face(&f, q, item, l->nearness, l->item);
        } else {
            fill_ball(&c->camera, &g->balls[item - g->faces], q, item, l->nearness, l->item);
        }
    }
    if (!filled) fill_cuts(c, g, q, l);
}

/* A mark becomes the colour of its image, whose pixels are about as large as those of the face. */
static void look_at_image(const canvas *c, const geometry *g, batch *b, int i, const int32_t v[3], float area)
{
    const tobi_image *m = c->images[image_number(b->b[i])];
    const vec *p = &g->color[v[0]], *q = &g->color[v[1]], *r = &g->color[v[2]];
    const float turn = (q->x - p->x)*(r->y - p->y) - (q->y - p->y)*(r->x - p->x);
    const float pixels = (float)m->width[0]*(float)m->height[0]*fabsf(turn);
    const vec color = image_color(m, image_level(m, pixels/(area > 1e-6f ? area : 1e-6f)), b->r[i], b->g[i]);
    b->r[i] = color.x, b->g[i] = color.y, b->b[i] = color.z;
}

/* The point of the plane for one of a back face that fill_cuts has seen. inside: its colour, or NULL. */
static void move_to_cut(const canvas *c, batch *b, int i, const vec *inside)
{
    const vec n = c->cut.normal[c->cut.faced - 1];
    const float to = n.x*b->x[i] + n.y*b->y[i] + n.z*b->z[i], t = c->cut.offset[c->cut.faced - 1]/to;
    if (!(t > 0 && t <= 1)) return;
    b->x[i] *= t, b->y[i] *= t, b->z[i] *= t;
    b->nx[i] = n.x, b->ny[i] = n.y, b->nz[i] = n.z;
    if (inside) b->r[i] = inside->x, b->g[i] = inside->y, b->b[i] = inside->z;
    b->r[i] *= 0.8f, b->g[i] *= 0.8f, b->b[i] *= 0.8f;      /* a cut is a little darker */
}

/* Adds an item's point at a place of the canvas to a batch. */
static void add_point(const canvas *c, const geometry *g, batch *b, int32_t item, float x, float y)
{
    const int i = b->count++;
    b->plain[i] = 0;
    if (item >= g->faces) {
        const ball *ball = &g->balls[item - g->faces];
        const spot at = project(&c->camera, ball->place);
        const float size = ball->radius*scale_at(&c->camera, ball->place.z);
        const float u = clampf((x - at.x)/size, -1, 1), v = clampf((at.y - y)/size, -1, 1);
        b->nx[i] = u, b->ny[i] = v, b->nz[i] = -sqrtf(above(1 - u*u - v*v));
        b->x[i] = ball->place.x + ball->radius*u, b->y[i] = ball->place.y + ball->radius*v;
        b->z[i] = ball->place.z + ball->radius*b->nz[i];
        b->r[i] = ball->color.x, b->g[i] = ball->color.y, b->b[i] = ball->color.z;
        b->plain[i] = c->camera.orthographic;
        return;
    }
    const int32_t *v = g->face[item];
    const spot *p = &g->at[v[0]], *q = &g->at[v[1]], *r = &g->at[v[2]];
    const vec *n = g->normal, *color = g->color;
    /* Areas of the parts of the triangle, then shares: perspective makes near corners count more. */
    float s0 = (r->x - q->x)*(y - q->y) - (r->y - q->y)*(x - q->x);
    float s1 = (p->x - r->x)*(y - r->y) - (p->y - r->y)*(x - r->x);
    float s2 = (q->x - p->x)*(y - p->y) - (q->y - p->y)*(x - p->x);
    const float sign = s0 + s1 + s2 < 0 ? -1.0f : 1.0f;      /* 1: a back face */
    s0 = above(sign*s0), s1 = above(sign*s1), s2 = above(sign*s2);
    const float area = s0 + s1 + s2, w0 = s0*p->nearness, w1 = s1*q->nearness, w2 = s2*r->nearness;
    float z, scale;
    if (c->camera.orthographic) {
        const float one = 1/area;
        z = -(w0 + w1 + w2)*one, scale = 1/c->camera.focal;
        s0 *= one, s1 *= one, s2 *= one;
    } else {
        const float one = 1/(w0 + w1 + w2);
        z = area*one, scale = z/c->camera.focal;
        s0 = w0*one, s1 = w1*one, s2 = w2*one;
    }
    b->x[i] = (x - c->camera.center_x)*scale, b->y[i] = (c->camera.center_y - y)*scale, b->z[i] = z;
    b->nx[i] = s0*n[v[0]].x + s1*n[v[1]].x + s2*n[v[2]].x;
    b->ny[i] = s0*n[v[0]].y + s1*n[v[1]].y + s2*n[v[2]].y;
    b->nz[i] = s0*n[v[0]].z + s1*n[v[1]].z + s2*n[v[2]].z;
    b->r[i] = s0*color[v[0]].x + s1*color[v[1]].x + s2*color[v[2]].x;
    b->g[i] = s0*color[v[0]].y + s1*color[v[1]].y + s2*color[v[2]].y;
    b->b[i] = s0*color[v[0]].z + s1*color[v[1]].z + s2*color[v[2]].z;
    b->plain[i] = c->camera.orthographic && b->nx[i] == 0 && b->ny[i] == 0 && b->nz[i] == 0;
    const vec *inside = is_image_mark(b->b[i]) ? &c->inside[image_number(b->b[i])] : NULL;
    if (inside) look_at_image(c, g, b, i, v, area);
    if (item < g->filled && c->cut.faced && sign > 0) move_to_cut(c, b, i, inside);
}

/* Of a pixel: its different surfaces, each with its number of samples and the sum of their places. */
typedef struct share { int32_t item; int count; float x, y, nearness; } share;

/* Faces whose nearness differs less than this share of it are one surface, if `join`. */
static const float same_surface = 0.02f;

static bool is_same(const geometry *g, const share *s, int32_t item, float nearness, bool join)
{
    if (s->item == item) return true;
    return join && item < g->faces && s->item < g->faces
        && fabsf(nearness - s->nearness) <= same_surface*fabsf(s->nearness);
}

/* Most pixels: all four samples see one surface. The same sums as below. */
static bool find_one_share(const layer *l, const square *q, const geometry *g, int px, int py, bool join,
                           share *out, float *most)
{
    const int k = 2*(py*q->side + px);
    const int32_t *i = l->item + k, *j = i + q->side;
    const float *a = l->nearness + k, *b = a + q->side;
    share s = { .item = i[0], .count = 4, .nearness = a[0] };
    if (i[0] < 0 || i[1] < 0 || j[0] < 0 || j[1] < 0) return false;
    if (!is_same(g, &s, i[1], a[1], join) || !is_same(g, &s, j[0], b[0], join) ||
        !is_same(g, &s, j[1], b[1], join)) return false;
    for (int n = 0; n < 4; n++) {
        s.x += q->left + ((float)(px*2 + n%2) + 0.5f)*q->step;
        s.y += q->top + ((float)(py*2 + n/2) + 0.5f)*q->step;
    }
    const float upper = a[1] > a[0] ? a[1] : a[0], lower = b[1] > b[0] ? b[1] : b[0];
    *most = lower > upper ? lower : upper;
    *out = s;
    return true;
}

/* Returns how many there are; *most is the nearness of the nearest. */
static int find_shares(const layer *l, const square *q, const geometry *g, int samples, int px, int py,
                       bool join,
                       share out[], float *most)
{
    int n = 0;
    if (samples == 2 && find_one_share(l, q, g, px, py, join, out, most)) return 1;
    *most = -INFINITY;
    for (int j = 0; j < samples; j++)
        for (int i = 0; i < samples; i++) {
            const int k = (py*samples + j)*q->side + px*samples + i;
            const int32_t item = l->item[k];
            const float nearness = l->nearness[k];
            int m = 0;
            if (item < 0) continue;
            *most = nearness > *most ? nearness : *most;
            while (m < n && !is_same(g, &out[m], item, nearness, join)) m++;
            if (m == n) out[n++] = (share){ .item = item, .nearness = nearness };
            out[m].count++;
            out[m].x += q->left + ((float)(px*samples + i) + 0.5f)*q->step;
            out[m].y += q->top + ((float)(py*samples + j) + 0.5f)*q->step;
        }
    return n;
}

/* Pixels of the tile that are on the canvas. */
static void tile_pixels(const canvas *c, const square *q, int *across, int *down)
{
    const int x = c->width - (int)q->left, y = c->height - (int)q->top;
    *across = x < TILE ? x : TILE;
    *down = y < TILE ? y : TILE;
}

static void clear_layer(layer *l, const square *q)
{
    const int n = q->side*q->side;
    for (int k = 0; k < n; k++) l->nearness[k] = -INFINITY;
    for (int k = 0; k < n; k++) l->item[k] = -1;
}

/* The surfaces of a pixel to the batch; what lies behind keeps the rest of the pixel. Returns the depth
   of the nearest. */
static float add_pixel(const painting *p, const layer *l, const square *q, int px, int py, bool join,
                       float thickness,
                       batch *b)
{
    canvas *c = p->c;
    const float all = 1/(float)(c->samples*c->samples);
    const int32_t k = ((int32_t)q->top + py)*c->width + (int32_t)q->left + px;
    share part[MOST_SAMPLES*MOST_SAMPLES];
    float nearest, rest = 1;
    const int n = find_shares(l, q, p->g, c->samples, px, py, join, part, &nearest);
    for (int m = 0; m < n; m++) {
        const float one = 1/(float)part[m].count, weight = (float)part[m].count*all;
        const int i = b->count;
        add_point(c, p->g, b, part[m].item, part[m].x*one, part[m].y*one);
        b->pixel[i] = k;
        b->weight[i] = weight;
        b->thickness[i] = above(thickness);
        rest -= weight;
    }
    if (n > 0) p->out[k] = vec_scale(above(rest), c->color[k]);
    return n > 0 ? depth_of(&c->camera, nearest) : INFINITY;
}

/* Room for the surfaces of one pixel. */
static bool is_full(const batch *b) { return b->count > BATCH - MOST_SAMPLES*MOST_SAMPLES; }

static void paint_opaque(const painting *p, int64_t tile, layer *l, batch *b)
{
    canvas *c = p->c;
    const square q = tile_square(c, p->t, tile);
    int across, down;
    const bool empty = p->t->first[tile] == p->t->first[tile + 1];
    if (c->nearness) c->covered[tile] = !empty;
    if (empty) return;
    clear_layer(l, &q);
    draw_items(p, tile, &q, l);
    tile_pixels(c, &q, &across, &down);
    if (c->nearness)
        memcpy(c->nearness + tile*q.side*q.side, l->nearness, (size_t)(q.side*q.side)*sizeof *l->nearness);
    for (int py = 0; py < down; py++)
        for (int px = 0; px < across; px++) {
            const float z = add_pixel(p, l, &q, px, py, false, 0, b);
            c->depth[((int64_t)q.top + py)*c->width + (int64_t)q.left + px] = z;
            if (is_full(b)) shade_solids(c, p->out, b);
        }
    shade_solids(c, p->out, b);
}

static void opaque_tiles(const void *view, int64_t begin, int64_t end)
{
    layer l;
    batch b = { .count = 0 };
    for (int64_t k = begin; k < end; k++) paint_opaque(view, k, &l, &b);
}

/* The depth of what is opaque at the middles of a tile's pixels. */
static void copy_depth(const canvas *c, const square *q, float *solid)
{
    int across, down;
    tile_pixels(c, q, &across, &down);
    if (across < TILE || down < TILE)
        for (int k = 0; k < TILE*TILE; k++) solid[k] = INFINITY;
    for (int y = 0; y < down; y++)
        memcpy(solid + y*TILE, c->depth + ((int64_t)q->top + y)*c->width + (int64_t)q->left,
               (size_t)across*sizeof *solid);
}

/* The front of the water into samples, and metres of water behind each pixel's middle, in front of what is
   opaque. The eye sees back faces from within water only. */
static void draw_water(const painting *p, int64_t tile, const square *q, layer *l, float *thickness)
{
    const canvas *c = p->c;
    const geometry *g = p->g;
    float solid[TILE*TILE];
    const square pixels = { q->left, q->top, TILE, 1 };
    copy_depth(c, q, solid);
    memset(thickness, 0, TILE*TILE*sizeof *thickness);
    for (int64_t i = p->t->first[tile]; i < p->t->first[tile + 1]; i++) {
        const int32_t item = p->t->item[i];
        const int32_t *v = g->face[item];
        face_setup f;
        if (!set_up_face(&f, &g->at[v[0]], &g->at[v[1]], &g->at[v[2]])) continue;
        if (f.facing > 0 || c->submerged) fill_face(&f, q, item, l->nearness, l->item);
        add_face_depth(&f, &pixels, c->camera.orthographic, solid, thickness);
    }
}

static void paint_water(const painting *p, int64_t tile, layer *l, float *thickness, batch *b)
{
    canvas *c = p->c;
    const square q = tile_square(c, p->t, tile);
    int across, down;
    if (p->t->first[tile] == p->t->first[tile + 1]) return;
    tile_pixels(c, &q, &across, &down);
    clear_layer(l, &q);
    if (c->covered[tile])
        memcpy(l->nearness, c->nearness + tile*q.side*q.side, (size_t)(q.side*q.side)*sizeof *l->nearness);
    draw_water(p, tile, &q, l, thickness);
    for (int py = 0; py < down; py++)
        for (int px = 0; px < across; px++) {
            const float z = add_pixel(p, l, &q, px, py, true, thickness[py*TILE + px], b);
            c->front[((int64_t)q.top + py)*c->width + (int64_t)q.left + px] = z;
            if (is_full(b)) shade_waters(c, p->out, b);
        }
    shade_waters(c, p->out, b);
}

static void water_tiles(const void *view, int64_t begin, int64_t end)
{
    layer l;
    batch b = { .count = 0 };
    float thickness[TILE*TILE];
    for (int64_t k = begin; k < end; k++) paint_water(view, k, &l, thickness, &b);
}

/* Drops in front of all else. */
static void paint_drops(const painting *p, int64_t tile, layer *l, batch *b)
{
    canvas *c = p->c;
    const square q = tile_square(c, p->t, tile);
    int across, down;
    if (p->t->first[tile] == p->t->first[tile + 1]) return;
    tile_pixels(c, &q, &across, &down);
    clear_layer(l, &q);
    if (c->covered[tile])
        memcpy(l->nearness, c->nearness + tile*q.side*q.side, (size_t)(q.side*q.side)*sizeof *l->nearness);
    draw_items(p, tile, &q, l);
    for (int py = 0; py < down; py++)
        for (int px = 0; px < across; px++) {
            const int64_t k = ((int64_t)q.top + py)*c->width + (int64_t)q.left + px;
            const vec before = c->color[k];
            const int count = b->count;
            const float z = add_pixel(p, l, &q, px, py, false, 0, b);
            if (z >= c->front[k]) {      /* none, or under water */
                b->count = count;
                c->color[k] = before;
                continue;
            }
            c->front[k] = z;
            for (int i = count; i < b->count; i++)
                b->under_r[i] = before.x, b->under_g[i] = before.y, b->under_b[i] = before.z;
            if (is_full(b)) shade_drops(c, p->out, b);
        }
    shade_drops(c, p->out, b);
}

static void drop_tiles(const void *view, int64_t begin, int64_t end)
{
    layer l;
    batch b = { .count = 0 };
    for (int64_t k = begin; k < end; k++) paint_drops(view, k, &l, &b);
}

/* The map of a shadow: c->depth, whose rows are as long as the map; and the range of each of its blocks. */
static void depth_tiles(const void *view, int64_t begin, int64_t end)
{
    const painting *p = view;
    canvas *c = p->c;
    layer l;
    for (int64_t tile = begin; tile < end; tile++) {
        const square q = tile_square(c, p->t, tile);
        clear_layer(&l, &q);
        draw_items(p, tile, &q, &l);
        for (int y = 0; y < TILE; y++)
            for (int x = 0; x < TILE; x++)
                c->depth[((int64_t)q.top + y)*c->width + (int64_t)q.left + x] = -l.nearness[y*TILE + x];
    }
}

/* How near the water is at the middles of the tile's pixels; -INFINITY: there is none. */
static void find_front(const painting *p, int64_t tile, layer *l)
{
    const square q = { (float)((int)(tile%p->t->across)*TILE), (float)((int)(tile/p->t->across)*TILE), TILE,
                       1 };
    const geometry *g = p->water;
    clear_layer(l, &q);
    if (!g || p->c->submerged) return;
    for (int64_t i = p->water_tiles->first[tile]; i < p->water_tiles->first[tile + 1]; i++) {
        const int32_t item = p->water_tiles->item[i], *v = g->face[item];
        face_setup f;
        if (set_up_face(&f, &g->at[v[0]], &g->at[v[1]], &g->at[v[2]]) && f.facing > 0)
            fill_face(&f, &q, item, l->nearness, l->item);
    }
}

/* A face of glass: its points to the batch, on the asked side of the water and before what is opaque. */
static void add_glass(const painting *p, int32_t item, const square *q, const float *front, glass_tile *t,
                      batch *b)
{
    const canvas *c = p->c;
    const int32_t *v = p->g->face[item];
    face_setup f;
    int x0, y0, x1, y1, across, down;
    if (!set_up_face(&f, &p->g->at[v[0]], &p->g->at[v[1]], &p->g->at[v[2]])) return;
    if (!sample_range(f.left - 1, f.right + 1, q->left, q, &x0, &x1) ||
        !sample_range(f.top - 1, f.bottom + 1, q->top, q, &y0, &y1)) return;
    tile_pixels(c, q, &across, &down);
    for (int y = y0; y <= y1 && y < down; y++)
        for (int x = x0; x <= x1 && x < across; x++) {
            const int k = y*TILE + x;
            const float px = q->left + (float)x, py = q->top + (float)y;
            const float cover = cover_pixel(&f, px, py, c->samples);
            if (!(cover > 0)) continue;
            const float near = nearness_at(&f, px + 0.5f, py + 0.5f), z = depth_of(&c->camera, near);
            const bool over = !c->submerged &&
                              (near > front[k] || z < depth_of(&c->camera, front[k]) + p->film);
            if (over != p->over || z >= c->depth[(int64_t)py*c->width + (int64_t)px]) continue;
            b->pixel[b->count] = find_layer(t, k, &f, near);
            b->weight[b->count] = cover;
            add_point(c, p->g, b, item, px + 0.5f, py + 0.5f);
            if (is_full(b)) shade_glass(c, t, b);
        }
}

static void glass_tiles(const void *view, int64_t begin, int64_t end)
{
    const painting *p = view;
    layer front;
    glass_tile t;
    batch b = { .count = 0 };
    for (int64_t tile = begin; tile < end; tile++) {
        const square q = { (float)((int)(tile%p->t->across)*TILE), (float)((int)(tile/p->t->across)*TILE),
                           TILE, 1 };
        int across, down;
        if (p->t->first[tile] == p->t->first[tile + 1]) continue;
        memset(t.count, 0, sizeof t.count);
        find_front(p, tile, &front);
        for (int64_t i = p->t->first[tile]; i < p->t->first[tile + 1]; i++)
            add_glass(p, p->t->item[i], &q, front.nearness, &t, &b);
        shade_glass(p->c, &t, &b);
        tile_pixels(p->c, &q, &across, &down);
        for (int y = 0; y < down; y++)
            for (int x = 0; x < across; x++) {
                const int64_t k = ((int64_t)q.top + y)*p->c->width + (int64_t)q.left + x;
                if (t.count[y*TILE + x]) p->out[k] = see_through(&t, y*TILE + x, p->out[k]);
            }
    }
}

static void sum_block(const node_view *v, int64_t b)
{
    float *node = v->node + b*BLOCK_NODES;
    const float inverse = 1/(v->reach*v->reach);
    if (!v->extra) memset(node, 0, BLOCK_NODES*sizeof *node);
    for (int64_t e = v->first[b]; e < v->first[b + 1]; e++) {
        const float weight = v->extra ? v->extra[v->entry[e]] : 1;
        float at[3];
        int low[3], high[3];
        if (!(weight > 0)) continue;
        for (int k = 0; k < 3; k++) {
            at[k] = v->place[v->entry[e]][k] - (float)(BLOCK_EDGE*v->block[b][k]);
            const float from = at[k] - v->reach, to = at[k] + v->reach;
            low[k] = from > 0 ? (int)from + 1 : 0;
            high[k] = to < BLOCK_EDGE - 1 ? (int)to : BLOCK_EDGE - 1;
        }
        float along[BLOCK_EDGE];
        TOBI_SIMD
        for (int x = 0; x < BLOCK_EDGE; x++) along[x] = ((float)x - at[0])*((float)x - at[0])*inverse;
        for (int z = low[2]; z <= high[2]; z++)
            for (int y = low[1]; y <= high[1]; y++) {
                const float dz = (float)z - at[2], dy = (float)y - at[1], rest = 1 - (dz*dz + dy*dy)*inverse;
                float *row = node + (z*BLOCK_EDGE + y)*BLOCK_EDGE;
                TOBI_SIMD
                for (int x = 0; x < BLOCK_EDGE; x++) {
                    const float t = rest - along[x], w = t > 0 ? t : 0;
                    row[x] += weight*(w*w*w);
                }
            }
    }
}

static void sum_nodes(const void *view, int64_t begin, int64_t end)
{
    const node_view *v = view;
    for (int64_t b = begin; b < end; b++)
        if (!v->touched || v->touched[b]) sum_block(v, b);
}

/* The nearest particle counts most by far: colours stay sharp. */
static void sum_block_colors(const node_view *v, int64_t b)
{
    float *colors = v->colors + (int64_t)v->colored[b]*4*BLOCK_NODES;
    const float inverse = 1/(v->reach*v->reach);
    memset(colors, 0, 4*BLOCK_NODES*sizeof *colors);
    for (int64_t e = v->first[b]; e < v->first[b + 1]; e++) {
        const vec color = v->color[v->entry[e]];
        float at[3];
        int low[3], high[3];
        for (int k = 0; k < 3; k++) {
            at[k] = v->place[v->entry[e]][k] - (float)(BLOCK_EDGE*v->block[b][k]);
            const float from = at[k] - v->reach, to = at[k] + v->reach;
            low[k] = from > 0 ? (int)from + 1 : 0;
            high[k] = to < BLOCK_EDGE - 1 ? (int)to : BLOCK_EDGE - 1;
        }
        for (int z = low[2]; z <= high[2]; z++)
            for (int y = low[1]; y <= high[1]; y++)
                for (int x = low[0]; x <= high[0]; x++) {
                    const float dz = (float)z - at[2], dy = (float)y - at[1], dx = (float)x - at[0];
                    const float t = 1 - (dx*dx + dy*dy + dz*dz)*inverse, w = power_16(t > 0 ? t : 0);
                    float *to = colors + 4*((z*BLOCK_EDGE + y)*BLOCK_EDGE + x);
                    to[0] += w*color.x, to[1] += w*color.y, to[2] += w*color.z, to[3] += w;
                }
    }
}

static void sum_colors(const void *view, int64_t begin, int64_t end)
{
    const node_view *v = view;
    for (int64_t b = begin; b < end; b++)
        if (v->colored[b] >= 0) sum_block_colors(v, b);
}

/* Each byte less the one of three neighbours, left, above and between, that is nearest to left + above -
   between (Paeth 1991). */
static void filter_row(const uint8_t *from, const uint8_t *before, int64_t row, int channels, uint8_t *to)
{
    *to++ = 4;
    for (int k = 0; k < channels; k++) to[k] = (uint8_t)(from[k] - before[k]);
    TOBI_SIMD
    for (int64_t k = channels; k < row; k++) {
        const int16_t left = from[k - channels], up = before[k], corner = before[k - channels];
        const int16_t a = (int16_t)(up - corner), b = (int16_t)(left - corner), c = (int16_t)(a + b);
        const int16_t pa = (int16_t)abs(a), pb = (int16_t)abs(b), pc = (int16_t)abs(c);
        const int16_t other = pb <= pc ? up : corner, near = (pa <= pb) & (pa <= pc) ? left : other;
        to[k] = (uint8_t)(from[k] - near);
    }
}

static void filter_rows(const void *view, int64_t begin, int64_t end)
{
    const filtering *v = view;
    for (int64_t y = begin; y < end; y++) {
        const uint8_t *from = v->from + y*v->row;
        uint8_t *to = v->to + y*(v->row + 1);
        if (y > 0) {
            filter_row(from, from - v->row, v->row, v->channels, to);
            continue;
        }
        *to++ = 1;      /* less the one on the left */
        memcpy(to, from, (size_t)v->channels);
        for (int64_t k = v->channels; k < v->row; k++) to[k] = (uint8_t)(from[k] - from[k - v->channels]);
    }
}

const tile_kernels JOIN(tile_kernels, TOBI_ISA) = { depth_tiles, opaque_tiles, water_tiles, drop_tiles,
                                                    glass_tiles, sum_nodes,
                                                    sum_colors, filter_rows };
