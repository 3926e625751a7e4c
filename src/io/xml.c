/* Texts in XML files: names come from users and may hold any byte. What is not UTF-8 is replaced instead of
   refused, because a name in a picture is not worth a failed run. Drawback: two odd names may become one. */
#include "io/xml.h"
#include <stdlib.h>
#include <string.h>

/* Length of the UTF-8 sequence at text, 0 if it is not one. */
static int utf8_length(const unsigned char *text)
{
    int n = text[0] < 0x80 ? 1 : text[0] >= 0xc2 && text[0] < 0xe0 ? 2
          : (text[0] & 0xf0) == 0xe0 ? 3 : text[0] >= 0xf0 && text[0] < 0xf5 ? 4 : 0;
    for (int i = 1; i < n; i++)
        if ((text[i] & 0xc0) != 0x80) return 0;
    return n;
}

char *tobi_xml_escape(const char *text)
{
    const unsigned char *at = (const unsigned char *)text;
    char *out = malloc(6*strlen(text) + 1), *end = out;      /* "&quot;" is the longest */
    while (out && *at) {
        int n = utf8_length(at);
        const char *name = *at == '&' ? "&amp;" : *at == '<' ? "&lt;" : *at == '>' ? "&gt;"
                         : *at == '"' ? "&quot;" : *at == '\'' ? "&apos;" : n == 0 || *at < 0x20 ? "_" : NULL;
        if (!name) memcpy(end, at, (size_t)n);
        end = name ? stpcpy(end, name) : end + n;
        at += n ? n : 1;
    }
    if (out) *end = '\0';
    return out;
}
