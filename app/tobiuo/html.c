/* Pieces of an HTML page. Drawback: a file that the page holds grows by a third, as base64 does. */
#include "report.h"
#include <stdlib.h>

enum { FILE_LIMIT = 32 << 20 };       /* bytes */

void html_text(FILE *file, const char *text)
{
    for (; *text; text++) {
        switch (*text) {
        case '&': fputs("&amp;", file); break;
        case '<': fputs("&lt;", file); break;
        case '>': fputs("&gt;", file); break;
        case '"': fputs("&quot;", file); break;
        default: fputc((unsigned char)*text < ' ' && *text != '\n' ? ' ' : *text, file);
        }
    }
}

void html_heads(FILE *file, const char *const *texts)
{
    for (; *texts; texts++) fprintf(file, **texts ? "<th>%s" : "<th class=doc>%s", tr(*texts));
}

static void write_base64(FILE *to, FILE *from)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    unsigned char byte[3];
    size_t n;
    while ((n = fread(byte, 1, 3, from)) > 0) {
        for (size_t k = n; k < 3; k++) byte[k] = 0;
        const unsigned word = (unsigned)byte[0] << 16 | (unsigned)byte[1] << 8 | byte[2];
        for (unsigned k = 0; k < 4; k++) fputc(k <= n ? digit[word >> (18 - 6*k) & 63] : '=', to);
    }
}

int html_data(FILE *file, const char *type, const char *path)
{
    FILE *from = fopen(path, "rb");
    if (!from) return -1;
    const int good = fseek(from, 0, SEEK_END) == 0 && ftell(from) > 0 && ftell(from) <= FILE_LIMIT;
    rewind(from);
    if (good) {
        fprintf(file, "data:%s;base64,", type);
        write_base64(file, from);
    }
    fclose(from);
    return good ? 0 : -1;
}
