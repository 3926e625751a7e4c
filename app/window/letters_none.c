/* A build without FreeType or fontconfig has the letters of English. Drawback: the window speaks English. */
#include "letters.h"

void letters_open(void) { }
void letters_close(void) { }

int letters_have(const char *text)
{
    while (*text && (unsigned char)*text < 0x80) text++;
    return !*text;
}

float letters_write(const tobi_overlay *o, float x, float y, float size, const char *text,
                    const uint8_t color[3])
{
    return tobi_overlay_text(o, x, y, size, text, color);
}

float letters_width(float size, const char *text) { return tobi_overlay_text_width(size, text); }
