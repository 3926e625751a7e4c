/* Letters of the fonts of the system, which fontconfig finds and FreeType draws: of the sans-serif one, and
   of the Japanese one for what that lacks. Decision 168. Drawback: other fonts, other pictures. */
#include "view/draw.h"
#include "tobiuo/overlay.h"
#include <fontconfig/fontconfig.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include <stdlib.h>

typedef struct face {
    FT_Face of;                  /* NULL: there is none                                            */
    float   em;                  /* over the height of capitals                                    */
} face;

struct tobi_letters {
    FT_Library library;
    face       plain, japanese;
    int        asked;            /* for the Japanese one                                           */
};

/* What capitals are of the em in most fonts: where a font has no H. */
static const float CAPITALS = 0.72f;

static float em_of(FT_Face of)
{
    const int is_there = FT_Load_Char(of, 'H', FT_LOAD_NO_SCALE) == 0 && of->glyph->metrics.horiBearingY > 0;
    if (!is_there) return 1/CAPITALS;
    return (float)of->units_per_EM/(float)of->glyph->metrics.horiBearingY;
}

/* wish: a pattern of fontconfig, which finds the nearest font. */
static face open_face(FT_Library library, const char *wish)
{
    face found = { 0 };
    FcPattern *pattern = FcNameParse((const FcChar8 *)wish), *font = NULL;
    FcResult result;
    FcChar8 *path;
    int index = 0;
    if (pattern && FcConfigSubstitute(NULL, pattern, FcMatchPattern)) {
        FcDefaultSubstitute(pattern);
        font = FcFontMatch(NULL, pattern, &result);
    }
    if (font && FcPatternGetString(font, FC_FILE, 0, &path) == FcResultMatch) {
        FcPatternGetInteger(font, FC_INDEX, 0, &index);
        if (FT_New_Face(library, (const char *)path, index, &found.of) != 0) found.of = NULL;
    }
    if (found.of) found.em = em_of(found.of);
    if (font) FcPatternDestroy(font);
    if (pattern) FcPatternDestroy(pattern);
    return found;
}

bool view_open_letters(tobi_letters **letters)
{
    tobi_letters *l = *letters = calloc(1, sizeof *l);
    if (!l || FT_Init_FreeType(&l->library) != 0) {
        free(l);
        *letters = NULL;
        return false;
    }
    if (FcInit()) l->plain = open_face(l->library, "sans-serif:scalable=true");
    if (!l->plain.of) {
        tobi_letters_close(l);
        *letters = NULL;
    }
    return true;
}

tobi_letters *tobi_letters_open(void)
{
    tobi_letters *letters;
    view_open_letters(&letters);
    return letters;
}

void tobi_letters_close(tobi_letters *l)
{
    if (!l) return;
    if (l->japanese.of) FT_Done_Face(l->japanese.of);
    if (l->plain.of) FT_Done_Face(l->plain.of);
    FT_Done_FreeType(l->library);
    free(l);
}

const char *tobi_letters_font(const tobi_letters *l) { return l ? l->plain.of->family_name : NULL; }

/* The letter at *text, of UTF-8, which is passed. */
static unsigned long next_letter(const char **text)
{
    const unsigned char *c = (const unsigned char *)*text;
    const int more = *c >= 0xf0 ? 3 : *c >= 0xe0 ? 2 : *c >= 0xc0 ? 1 : 0;
    unsigned long letter = more ? *c & (0x3f >> more) : *c;
    int k = 1;
    for (; k <= more && (c[k] & 0xc0) == 0x80; k++) letter = letter << 6 | (c[k] & 0x3f);
    *text += k;
    return letter;
}

/* The face that has a letter, or the plain one, whose glyph 0 stands for what is nowhere. */
static const face *face_of(tobi_letters *l, unsigned long letter, FT_UInt *glyph)
{
    *glyph = FT_Get_Char_Index(l->plain.of, letter);
    if (*glyph == 0 && !l->asked) {
        l->japanese = open_face(l->library, "sans-serif:lang=ja:scalable=true");
        l->asked = 1;
    }
    if (*glyph != 0 || !l->japanese.of) return &l->plain;
    *glyph = FT_Get_Char_Index(l->japanese.of, letter);
    return *glyph != 0 ? &l->japanese : &l->plain;
}

int tobi_letters_have(tobi_letters *l, const char *text)
{
    FT_UInt glyph = 1;
    while (l && text && *text && glyph != 0) face_of(l, next_letter(&text), &glyph);
    return l && text && glyph != 0;
}

static void paint_bitmap(const FT_GlyphSlot g, int x, int y, view_paint_pixel *paint, void *user)
{
    const FT_Bitmap *b = &g->bitmap;
    if (b->pixel_mode != FT_PIXEL_MODE_GRAY) return;
    for (int v = 0; v < (int)b->rows; v++)
        for (int u = 0; u < (int)b->width; u++) {
            const unsigned char share = b->buffer[v*b->pitch + u];
            if (share) paint(user, x + g->bitmap_left + u, y - g->bitmap_top + v, (float)share/255);
        }
}

float view_walk_letters(tobi_letters *l, float x, float y, float size, const char *text,
                        view_paint_pixel *paint, void *user)
{
    const float from = x;
    while (l && text && *text) {
        FT_UInt glyph;
        const face *f = face_of(l, next_letter(&text), &glyph);
        const FT_GlyphSlot g = f->of->glyph;
        FT_Set_Char_Size(f->of, 0, (FT_F26Dot6)(64*f->em*size + 0.5f), 72, 72);
        if (FT_Load_Glyph(f->of, glyph, FT_LOAD_NO_BITMAP | FT_LOAD_TARGET_LIGHT) != 0) continue;
        if (paint && g->format == FT_GLYPH_FORMAT_OUTLINE) {
            const float left = floorf(x);
            FT_Outline_Translate(&g->outline, (FT_Pos)(64*(x - left)), 0);
            if (FT_Render_Glyph(g, FT_RENDER_MODE_NORMAL) == 0)
                paint_bitmap(g, (int)left, (int)floorf(y + 0.5f), paint, user);
        }
        x += (float)g->linearHoriAdvance/65536;
    }
    return x - from;
}
