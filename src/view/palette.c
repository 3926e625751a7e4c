/* The colours of a picture whose things have colours of their own: of each material its skin, its core and
   the faces of cuts, each in the tints that tell pieces apart. Drawback: many pieces share a tint. */
#include "base/error.h"
#include "view/drawing.h"
#include <stdlib.h>
#include <string.h>

/* Values of the field part. */
enum { SKIN, CORE, FACE, PARTS };

/* The second piece of a solid and all after it are mixed with one of these, so that halves which lie face to
   face can be told apart. */
static const float tints[][3] = {
    { 0.10f, 0.30f, 0.90f }, { 0.95f, 0.75f, 0.05f }, { 0.10f, 0.65f, 0.30f }, { 0.55f, 0.15f, 0.75f },
    { 0.95f, 0.45f, 0.05f }, { 0.05f, 0.65f, 0.75f },
};
enum { TINTS = 1 + sizeof tints/sizeof *tints };

/* Of liquids without a colour of their own, by their number among the kinds. */
static const float liquids[][3] = {
    { 0.10f, 0.40f, 0.50f }, { 0.90f, 0.62f, 0.12f }, { 0.30f, 0.62f, 0.25f }, { 0.75f, 0.25f, 0.30f },
};

/* Of solids without one beside liquids, by their number; alone they are blue. Bodies have others. */
static const float solids[][3] = {
    { 0.92f, 0.82f, 0.50f }, { 0.56f, 0.43f, 0.35f }, { 0.88f, 0.62f, 0.68f }, { 0.66f, 0.74f, 0.62f },
};

static void mix(float color[3], const float with[3], float share)
{
    for (int k = 0; k < 3; k++) color[k] += share*(with[k] - color[k]);
}

static void set_color(const double *color, const float otherwise[3], float out[3])
{
    for (int k = 0; k < 3; k++) out[k] = color[0] < 0 ? otherwise[k] : (float)(color[k]/255.0);
}

static int has_liquid(const tobi_looks *s)
{
    for (int m = 0; m < s->material_count; m++)
        if (s->materials[m].liquid) return 1;
    return 0;
}

/* How many kinds of liquid, or how many solids, there are before a material. */
static int count_kinds(const tobi_looks *s, int material)
{
    const tobi_material_look *look = &s->materials[material];
    int kind = 0;
    for (int k = 0; k < (look->liquid ? look->kind : material); k++)
        kind += s->materials[k].liquid == look->liquid && (!look->liquid || s->materials[k].kind == k);
    return kind;
}

static const float *find_default(const tobi_looks *s, int material)
{
    static const float alone[3] = { 0.04f, 0.36f, 0.70f };
    if (s->materials[material].liquid) return liquids[count_kinds(s, material)%4];
    return has_liquid(s) ? solids[count_kinds(s, material)%4] : alone;
}

/* Without a core of its own, a cut face is paler than its material, or darker where that is pale. */
static void find_color(const tobi_looks *s, int material, int part, int tint, float out[3])
{
    static const float white[3] = { 1, 1, 1 }, black[3] = { 0, 0, 0 };
    const tobi_material_look *look = &s->materials[material];
    const int cored = look->core_color[0] >= 0;
    set_color(part != SKIN && cored ? look->core_color : look->color, find_default(s, material), out);
    const int pale = out[0] + out[1] + out[2] > 2;
    if (part == FACE && !cored) mix(out, pale ? black : white, pale ? 0.15f : 0.4f);
    if (tint > 0) mix(out, tints[tint - 1], 0.3f);
}

int tobi_drawing_color(const tobi_drawing *d, int material, int part, int piece)
{
    const tobi_looks *s = d->looks;
    if (material < 0 || material >= s->material_count) material = 0;
    if (part < SKIN || part >= PARTS) part = SKIN;
    /* In 3-D the pieces have surfaces of their own. */
    const int tint = s->dimension == 2 && d->tint && piece >= 0 && piece < d->pieces ? d->tint[piece] : 0;
    return (material*TINTS + tint)*PARTS + part;
}

/* A piece of a solid, by what its particles say. */
typedef struct fragment { int64_t piece, particles, first; int material; } fragment;

static int order_fragments(const void *a, const void *b)
{
    const fragment *p = a, *q = b;
    if (p->material != q->material) return p->material < q->material ? -1 : 1;
    return p->first < q->first ? -1 : p->first > q->first;
}

/* Pieces as numbers from 0, each with its material, size and least id. */
static fragment *list_pieces(const tobi_drawing *d, const tobi_moment_field *id, int64_t *count)
{
    const int64_t n = d->moment->count;
    *count = 0;
    for (int64_t i = 0; i < n; i++) {
        const double p = d->piece->values[i];
        if (p >= 0 && p < (double)n && (int64_t)p >= *count) *count = (int64_t)p + 1;
    }
    fragment *list = calloc((size_t)*count + 1, sizeof *list);
    for (int64_t i = 0; list && i < n; i++) {
        const double p = d->piece->values[i], own = id ? id->values[i] : (double)i;
        if (!(p >= 0 && p < (double)*count)) continue;
        fragment *f = &list[(int64_t)p];
        if (f->particles++ == 0 || own < (double)f->first) f->first = (int64_t)own;
        f->piece = (int64_t)p;
        f->material = d->material ? (int)d->material->values[i] : 0;
    }
    return list;
}

/* The tint of each piece, by its first particle, so that it keeps it as long as there are few: the first
   piece of a solid has none, nor has debris. */
static tobi_status choose_tints(tobi_drawing *d, const tobi_moment_field *id, tobi_error *err)
{
    int taken[TINTS] = { 0 }, material = -1;
    const int64_t least = d->looks->dimension == 2 ? 4 : 8;      /* particles, of what is not debris */
    fragment *list = list_pieces(d, id, &d->pieces);
    d->tint = calloc((size_t)d->pieces + 1, sizeof *d->tint);
    if (!list || !d->tint) {
        free(list);
        return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    }
    qsort(list, (size_t)d->pieces, sizeof *list, order_fragments);
    for (int64_t k = 0; k < d->pieces; k++) {
        const fragment *f = &list[k];
        if (f->particles < least) continue;
        if (f->material != material) {
            memset(taken, 0, sizeof taken);
            material = f->material;
            continue;
        }
        int tint = 1 + (int)((uint64_t)f->first*0x9e3779b97f4a7c15u >> 33)%(TINTS - 1);
        for (int n = 0; n < TINTS && taken[tint]; n++) tint = tint%(TINTS - 1) + 1;
        taken[tint] = 1;
        d->tint[f->piece] = (uint8_t)tint;
    }
    free(list);
    return TOBI_OK;
}

void tobi_looks_color(const tobi_looks *looks, int material, int part, float color[4])
{
    static const float plain[4] = { 0.5f, 0.5f, 0.5f, 1 };
    static const float share_of_liquid = 0.6f;      /* of light that is kept away */
    if (!color) return;
    memcpy(color, plain, sizeof plain);
    if (!looks || material < 0 || material >= looks->material_count) return;
    const tobi_material_look *look = &looks->materials[material];
    find_color(looks, material, part < SKIN || part >= PARTS ? SKIN : part, 0, color);
    if (look->liquid) color[3] = share_of_liquid;
}

/* Whether a material is seen, and is no liquid of the kind of one that was before. */
static int is_new(const tobi_looks *s, int material)
{
    const tobi_material_look *look = &s->materials[material];
    for (int m = 0; m < material; m++) {
        const tobi_material_look *other = &s->materials[m];
        if (other->visible && other->liquid && look->liquid && other->kind == look->kind) return 0;
    }
    return look->visible;
}

tobi_status tobi_drawing_make_palette(tobi_drawing *d, const tobi_moment_field *id, tobi_error *err)
{
    const tobi_looks *s = d->looks;
    int kinds = 0, colored = 0, any_solid = 0;
    d->colors = s->material_count*PARTS*TINTS;
    d->palette = malloc(((size_t)d->colors + 1)*sizeof *d->palette);
    if (!d->palette) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    for (int m = 0; m < s->material_count; m++) {
        const tobi_material_look *look = &s->materials[m];
        kinds += look->liquid && is_new(s, m);
        any_solid |= look->visible && !look->liquid;
        colored |= look->visible && (look->color[0] >= 0 || look->core_color[0] >= 0 || look->skin.image);
        for (int c = 0; c < PARTS*TINTS; c++)
            find_color(s, m, c%PARTS, c/PARTS, d->palette[m*PARTS*TINTS + c]);
    }
    d->has_palette = (colored || kinds + any_solid > 1) && !d->view->field && !d->view->look;
    return (d->has_palette || d->view->field_of) && d->piece ? choose_tints(d, id, err) : TOBI_OK;
}
