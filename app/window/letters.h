/* Letters over the picture in the language of the user. */
#pragma once
#include "tobiuo/overlay.h"

/* Looks for letters of Japanese, where that is the language. */
void letters_open(void);
void letters_close(void);
/* 1: all of the text can be written. */
int letters_have(const char *text);
/* As tobi_overlay_text and tobi_overlay_text_width, for UTF-8. */
float letters_write(const tobi_overlay *o, float x, float y, float size, const char *text,
                    const uint8_t color[3]);
float letters_width(float size, const char *text);
