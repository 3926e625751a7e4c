/* Errors are a status and a text that the failing call writes where its caller says. Drawback: the
   text has a fixed room and is cut beyond it. */
#include "base/error.h"
#include <stdio.h>
#include <string.h>

tobi_status tobi_fail(tobi_error *err, tobi_status status, const char *format, ...)
{
    if (!err) return status;
    err->status = status;
    err->key[0] = '\0';
    va_list args;
    va_start(args, format);
    vsnprintf(err->text, sizeof err->text, tobi_text(format), args);
    va_end(args);
    tobi_text_mend(err->text);
    return status;
}

tobi_status tobi_at_key(tobi_error *err, tobi_status status, const char *format, ...)
{
    if (!err || status == TOBI_OK || err->key[0]) return status;
    va_list args;
    va_start(args, format);
    vsnprintf(err->key, sizeof err->key, format, args);
    va_end(args);
    return status;
}

tobi_short_text tobi_excerpt(const char *text)
{
    tobi_short_text out = { "" };
    size_t n = 0;
    for (; n < TOBI_EXCERPT && text[n]; n++)
        out.text[n] = (unsigned char)text[n] < ' ' || text[n] == 127 ? '?' : text[n];
    if (!text[n]) return out;
    while (n > 0 && ((unsigned char)text[n] & 0xc0) == 0x80) n--;      /* no half of a letter */
    memcpy(out.text + n, "...", 4);
    return out;
}
