/* Lines and letters over pixels that are there: marks and legends of a picture, of a window. Everything is
   cut off at the edges; coordinates are pixels from the upper left corner, and may lie between pixels. */
#ifndef TOBIUO_OVERLAY_H
#define TOBIUO_OVERLAY_H
#include "tobiuo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Letters of the sans-serif font of the system, and of its Japanese one for those that it lacks. For one
   thread at a time. */
typedef struct tobi_letters tobi_letters;
/* NULL: the system has no font, or no memory. Freed by tobi_letters_close, which takes NULL too. */
TOBI_API tobi_letters *tobi_letters_open(void);
TOBI_API void tobi_letters_close(tobi_letters *letters);
/* 1: all letters of a text (UTF-8) are there. */
TOBI_API int tobi_letters_have(tobi_letters *letters, const char *text);
/* Name of the sans-serif font, owned by the letters; NULL for NULL. */
TOBI_API const char *tobi_letters_font(const tobi_letters *letters);

typedef struct tobi_overlay {
    uint8_t *rgb;                      /* width x height x 3, borrowed */
    int width, height;
    tobi_letters *letters;             /* borrowed; NULL: texts are not drawn, and have the width 0 */
} tobi_overlay;

/* share: of the colour, 0 to 1; the rest is what was there. Colours are sRGB, 0 to 255. */
TOBI_API void tobi_overlay_box(const tobi_overlay *o, int x, int y, int width, int height,
                               const uint8_t color[3],
                               float share);
TOBI_API void tobi_overlay_line(const tobi_overlay *o, float x0, float y0, float x1, float y1,
                                float thickness,
                                const uint8_t color[3]);
/* UTF-8. x, y: left end of the baseline; size: height of capitals. Returns the width. */
TOBI_API float tobi_overlay_text(const tobi_overlay *o, float x, float y, float size, const char *text,
                                 const uint8_t color[3]);
TOBI_API float tobi_overlay_text_width(const tobi_overlay *o, float size, const char *text);

#ifdef __cplusplus
}
#endif
#endif
