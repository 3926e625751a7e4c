/* Letters of Japanese from a font of the system, which fontconfig finds and FreeType draws. A text of ASCII
   alone has the strokes of the library, as in pictures. Drawback: the window looks as the font does. */
#include "letters.h"
#include "../tobiuo/language.h"
#include <fontconfig/fontconfig.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include <string.h>

/* Pixels of the em for a capital of one pixel, in fonts of Japanese. */
static const float EM = 1.45f;
static FT_Library library;
static FT_Face face;

/* The font that the system has for Japanese; that may be one without Japanese. */
static void open_face(void)
{
    FcPattern *wish = FcNameParse((const FcChar8 *)":lang=ja:scalable=true"), *found = NULL;
    FcResult result;
    FcChar8 *path;
    int index = 0;
    if (wish && FcConfigSubstitute(NULL, wish, FcMatchPattern)) {
        FcDefaultSubstitute(wish);
        found = FcFontMatch(NULL, wish, &result);
    }
    if (found && FcPatternGetString(found, FC_FILE, 0, &path) == FcResultMatch) {
        FcPatternGetInteger(found, FC_INDEX, 0, &index);
        if (FT_New_Face(library, (const char *)path, index, &face) != 0) face = NULL;
    }
    if (found) FcPatternDestroy(found);
    if (wish) FcPatternDestroy(wish);
}

void letters_open(void)
{
    if (face || strcmp(language_name(), "ja") != 0 || FT_Init_FreeType(&library) != 0) return;
    if (FcInit()) open_face();
    if (!face) letters_close();
}

void letters_close(void)
{
    if (face) FT_Done_Face(face);
    if (library) FT_Done_FreeType(library);
    face = NULL;
    library = NULL;
}

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

static int is_plain(const char *text)
{
    while (*text && (unsigned char)*text < 0x80) text++;
    return !*text;
}

int letters_have(const char *text)
{
    if (is_plain(text)) return 1;
    while (face && *text)
        if (FT_Get_Char_Index(face, next_letter(&text)) == 0) return 0;
    return face != NULL;
}

static void draw_bitmap(const tobi_overlay *o, int x, int y, const FT_Bitmap *b, const uint8_t color[3])
{
    for (int v = 0; v < (int)b->rows; v++)
        for (int u = 0; u < (int)b->width; u++) {
            const unsigned char share = b->buffer[v*b->pitch + u];
            if (share) tobi_overlay_box(o, x + u, y + v, 1, 1, color, (float)share/255);
        }
}

/* o: NULL only measures. */
static float walk_text(const tobi_overlay *o, float x, float y, float size, const char *text,
                       const uint8_t color[3])
{
    const float from = x;
    FT_Set_Pixel_Sizes(face, 0, (FT_UInt)(EM*size + 0.5f));
    while (*text) {
        const FT_Int32 flags = FT_LOAD_NO_BITMAP | (o ? FT_LOAD_RENDER : FT_LOAD_DEFAULT);
        if (FT_Load_Char(face, next_letter(&text), flags) != 0) continue;
        const FT_GlyphSlot g = face->glyph;
        if (o && g->bitmap.pixel_mode == FT_PIXEL_MODE_GRAY)
            draw_bitmap(o, (int)(x + 0.5f) + g->bitmap_left, (int)(y + 0.5f) - g->bitmap_top, &g->bitmap,
                        color);
        x += (float)g->advance.x/64;
    }
    return x - from;
}

float letters_write(const tobi_overlay *o, float x, float y, float size, const char *text,
                    const uint8_t color[3])
{
    if (!face || is_plain(text)) return tobi_overlay_text(o, x, y, size, text, color);
    return walk_text(o, x, y, size, text, color);
}

float letters_width(float size, const char *text)
{
    if (!face || is_plain(text)) return tobi_overlay_text_width(size, text);
    return walk_text(NULL, 0, 0, size, text, NULL);
}
