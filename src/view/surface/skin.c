/* Texture coordinates of the surfaces of solids, for files. Vertices get what the particles around differ
   from an affine map of their group, as a field; then each triangle reads the skin (skin.c). Drawback: the
   arrays of the surface are copied to double vertices at seams. */
#include "view/skin.h"
#include "tobiuo/surface.h"
#include <stdlib.h>
#include <string.h>

typedef struct group_map { int32_t group; int16_t skin; rest_map map; } group_map;

/* A vertex again, with other coordinates. */
typedef struct copy { int32_t from; int16_t skin; float uv[2]; } copy;

typedef struct work {
    const tobi_surface_def *d;
    const tobi_surface_skins *k;
    group_map *maps;
    int64_t map_count;
    double (*off)[3];            /* of particles                               */
    tobi_surface *s;
    double (*at)[3];             /* of vertices at rest                        */
    float (*uv)[2], *depth;
    int16_t *skin;               /* of vertices, by their group                */
    uint8_t *taken;
    copy *copies;
    int64_t copy_count;
} work;

static void free_work(work *w)
{
    free(w->maps);
    free(w->off);
    free(w->at);
    free(w->uv);
    free(w->depth);
    free(w->skin);
    free(w->taken);
    free(w->copies);
}

static tobi_status no_memory(tobi_error *err)
{
    return tobi_fail(err, TOBI_NO_MEMORY, "surface: no memory for texture coordinates");
}

static int compare_keys(const void *a, const void *b)
{
    const uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return p < q ? -1 : p > q;
}

static int32_t group_of(const tobi_surface_def *d, int64_t i) { return d->group ? d->group[i] : 0; }

static bool has_skin(const work *w, int64_t i)
{
    const int skin = w->k->skin[i];
    const double *x = w->d->positions[i];
    return skin >= 0 && skin < w->k->count && w->k->skins[skin].image && group_of(w->d, i) >= 0 &&
           fabs(x[0]) + fabs(x[1]) + fabs(x[2]) < INFINITY;
}

/* The maps of the groups of rows that lie side by side, in rising order. */
static void fit_groups(work *w, const int32_t *row, int64_t count, vec *off)
{
    for (int64_t begin = 0, end; begin < count; begin = end) {
        const int32_t group = group_of(w->d, row[begin]);
        for (end = begin + 1; end < count && group_of(w->d, row[end]) == group;) end++;
        group_map *m = &w->maps[w->map_count++];
        m->group = group, m->skin = w->k->skin[row[begin]];
        view_fit_rest(w->d->positions, w->k->rest, row + begin, end - begin, &m->map, off);
    }
    for (int64_t n = 0; n < count; n++) {
        const int32_t i = row[n];
        w->off[i][0] = (double)off[i].x, w->off[i][1] = (double)off[i].y, w->off[i][2] = (double)off[i].z;
    }
}

static tobi_status fit_maps(work *w, tobi_error *err)
{
    const size_t n = (size_t)w->d->particle_count + 1;
    uint64_t *key = malloc(n*sizeof *key);
    int32_t *row = malloc(n*sizeof *row);
    vec *off = malloc(n*sizeof *off);
    int64_t count = 0;
    w->maps = malloc(n*sizeof *w->maps);
    w->off = calloc(n, sizeof *w->off);
    const bool enough = key && row && off && w->maps && w->off;
    for (int64_t i = 0; enough && i < w->d->particle_count; i++)
        if (has_skin(w, i)) key[count++] = (uint64_t)(uint32_t)group_of(w->d, i) << 32 | (uint32_t)i;
    if (enough) {
        qsort(key, (size_t)count, sizeof *key, compare_keys);
        for (int64_t n_th = 0; n_th < count; n_th++) row[n_th] = (int32_t)(uint32_t)key[n_th];
        fit_groups(w, row, count, off);
    }
    free(key);
    free(row);
    free(off);
    return enough ? TOBI_OK : no_memory(err);
}

static int compare_groups(const void *a, const void *b)
{
    const int32_t p = ((const group_map *)a)->group, q = ((const group_map *)b)->group;
    return (p > q) - (p < q);
}

static void look_range(const void *view, int64_t begin, int64_t end)
{
    const work *w = view;
    const tobi_surface *s = w->s;
    const float *off = s->fields[s->field_count];
    for (int64_t i = begin; i < end; i++) {
        const group_map wanted = { .group = s->group[i] };
        const group_map *m = bsearch(&wanted, w->maps, (size_t)w->map_count, sizeof *m, compare_groups);
        w->skin[i] = m ? m->skin : -1;
        if (!m) continue;
        const tobi_picture_skin *skin = &w->k->skins[m->skin];
        view_apply_map(&m->map, s->vertices[i], w->at[i]);
        for (int a = 0; a < 3; a++) w->at[i][a] += (double)off[3*i + a];
        w->depth[i] = (float)skin->look(skin->user, w->at[i], w->uv[i]);
    }
}

/* skin -2: of the inside. */
static void set_corner(work *w, int32_t *corner, int16_t skin, const float uv[2])
{
    tobi_surface *s = w->s;
    const int32_t i = *corner;
    if (!w->taken[i]) {
        w->taken[i] = 1;
        s->skin[i] = skin;
        memcpy(s->uv[i], uv, sizeof s->uv[i]);
    } else if (s->skin[i] != skin || memcmp(s->uv[i], uv, sizeof s->uv[i]) != 0) {
        copy *c = &w->copies[w->copy_count];
        *c = (copy){ i, skin, { uv[0], uv[1] } };
        *corner = (int32_t)(s->vertex_count + w->copy_count++);
    }
}

static void read_triangle(work *w, int32_t *v)
{
    double at[3][3];
    float depth[3], uv[3][2];
    const int16_t skin = w->skin[v[0]];
    if (skin < 0) return;
    for (int k = 0; k < 3; k++) {
        memcpy(at[k], w->at[v[k]], sizeof at[k]);
        memcpy(uv[k], w->uv[v[k]], sizeof uv[k]);
        depth[k] = w->depth[v[k]];
    }
    const bool shown = view_skin_face(&w->k->skins[skin], (const double (*)[3])at, depth, uv);
    if (!shown) memset(uv, 0, sizeof uv);
    for (int k = 0; k < 3; k++) set_corner(w, &v[k], shown ? skin : -2, uv[k]);
}

/* An array of the surface with its copies behind; NULL: no memory, and it stays as it was. */
static void *lengthen(void *array, size_t size, const work *w)
{
    const int64_t n = w->s->vertex_count;
    char *longer = tobi_array_make(n + w->copy_count + 1, size);
    if (!longer) return NULL;
    memcpy(longer, array, (size_t)n*size);
    for (int64_t k = 0; k < w->copy_count; k++)
        memcpy(longer + (size_t)(n + k)*size, (char *)array + (size_t)w->copies[k].from*size, size);
    tobi_array_free(array);
    return longer;
}

#define LENGTHEN(array, size) \
    do { \
        void *longer = lengthen(array, size, w); \
        if (!longer) return no_memory(err); \
        array = longer; \
    } while (0)

static tobi_status add_copies(work *w, tobi_error *err)
{
    tobi_surface *s = w->s;
    const size_t n = (size_t)(s->vertex_count + w->copy_count) + 1;
    int16_t *skin = realloc(s->skin, n*sizeof *skin);
    if (skin) s->skin = skin;
    float (*uv)[2] = realloc(s->uv, n*sizeof *uv);
    if (uv) s->uv = uv;
    if (!skin || !uv) return no_memory(err);
    LENGTHEN(s->vertices, sizeof *s->vertices);
    LENGTHEN(s->normals, sizeof *s->normals);
    LENGTHEN(s->group, sizeof *s->group);
    LENGTHEN(s->sides, sizeof *s->sides);
    for (int f = 0; f < s->field_count; f++)
        LENGTHEN(s->fields[f], (size_t)s->field_components[f]*sizeof(float));
    for (int64_t k = 0; k < w->copy_count; k++) {
        s->skin[s->vertex_count + k] = w->copies[k].skin;
        memcpy(s->uv[s->vertex_count + k], w->copies[k].uv, sizeof *s->uv);
    }
    s->vertex_count += w->copy_count;
    return TOBI_OK;
}

static void set_colors(work *w)
{
    tobi_surface *s = w->s;
    for (int f = 0; f < s->field_count; f++) {
        if (s->field_components[f] != 4 || strcmp(s->field_names[f], "color") != 0) continue;
        for (int64_t i = 0; i < s->vertex_count; i++) {
            const int64_t own = i < s->vertex_count - w->copy_count ? i
                : w->copies[i - (s->vertex_count - w->copy_count)].from;
            for (int c = 0; c < 4 && s->skin[i] != -1; c++)
                s->fields[f][4*i + c] = s->skin[i] >= 0 || c == 3 ? 1 : w->k->skins[w->skin[own]].inside[c];
        }
    }
    for (int64_t i = 0; i < s->vertex_count; i++)
        if (s->skin[i] < 0) s->skin[i] = -1;
}

static tobi_status put_on(work *w, tobi_error *err)
{
    tobi_surface *s = w->s;
    const size_t n = (size_t)s->vertex_count + 1;
    tobi_exec exec;
    s->field_count--;                        /* the last is that of the map */
    s->skins = w->k->skins;
    s->skin = malloc(n*sizeof *s->skin);
    s->uv = calloc(n, sizeof *s->uv);
    w->at = malloc(n*sizeof *w->at);
    w->uv = malloc(n*sizeof *w->uv);
    w->depth = malloc(n*sizeof *w->depth);
    w->skin = malloc(n*sizeof *w->skin);
    w->taken = calloc(n, 1);
    w->copies = malloc((3*(size_t)s->triangle_count + 1)*sizeof *w->copies);
    if (!s->skin || !s->uv || !w->at || !w->uv || !w->depth || !w->skin || !w->taken || !w->copies)
        return no_memory(err);
    memset(s->skin, -1, n*sizeof *s->skin);
    TOBI_TRY(tobi_exec_init(&exec, w->d->threads, err));
    tobi_loop(exec.threads, s->vertex_count, 0, look_range, w);
    tobi_exec_free(&exec);
    for (int64_t t = 0; t < s->triangle_count; t++) read_triangle(w, s->triangles[t]);
    TOBI_TRY(add_copies(w, err));
    set_colors(w);
    tobi_array_free(s->fields[s->field_count]);
    s->fields[s->field_count] = NULL;
    return TOBI_OK;
}

static tobi_status make(work *w, tobi_surface **surface, tobi_error *err)
{
    tobi_surface_field fields[TOBI_SURFACE_FIELD_LIMIT];
    tobi_surface_def d = *w->d;
    TOBI_TRY(fit_maps(w, err));
    for (int f = 0; f < d.field_count; f++) fields[f] = d.fields[f];
    fields[d.field_count++] = (tobi_surface_field){ "off", 3, w->off[0] };
    d.fields = fields;
    TOBI_TRY(tobi_surface_make(&d, surface, err));
    w->s = *surface;
    const tobi_status status = put_on(w, err);
    if (status == TOBI_OK) return TOBI_OK;
    tobi_surface_free(*surface);
    *surface = NULL;
    return status;
}

tobi_status tobi_surface_make_skinned(const tobi_surface_def *def, const tobi_surface_skins *skins,
                                      tobi_surface **surface, tobi_error *err)
{
    TOBI_NEED(def, "definition");
    TOBI_NEED(skins, "skins");
    TOBI_NEED(surface, "surface");
    *surface = NULL;
    if (def->field_count < 0 || def->field_count >= TOBI_SURFACE_FIELD_LIMIT)
        return tobi_fail(err, TOBI_INVALID, "surface: %d fields, with skins allowed are 0 to %d",
                         def->field_count, TOBI_SURFACE_FIELD_LIMIT - 1);
    if (def->particle_count < 0 || def->particle_count > INT32_MAX || !def->positions || !skins->skin ||
        !skins->rest)
        return tobi_surface_make(def, surface, err);
    work w = { .d = def, .k = skins };
    const tobi_status status = make(&w, surface, err);
    free_work(&w);
    return status;
}
