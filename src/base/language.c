/* The language of messages. It is of the whole process, as with setlocale: an error has no world to ask.
   Drawback: it is the one global state of the library. */
#include "base/error.h"
#include "tobiuo/tobiuo.h"
#include <string.h>

void tobi_texts_sort(void);
const char *tobi_texts_find(const char *text) __attribute__((format_arg(1)));
void tobi_page_texts_sort(void);
const char *tobi_page_texts_find(const char *text);

static int is_japanese;

const char *tobi_text(const char *english) { return is_japanese ? tobi_texts_find(english) : english; }

/* [text](page.md) becomes text, and lines become one. */
const char *tobi_meaning(const char *english, char room[TOBI_MEANING])
{
    const char *found = is_japanese ? tobi_page_texts_find(english) : english, *end = NULL;
    size_t used = 0;
    if (found == english) return tobi_text(english);
    for (const char *c = found; *c && used + 1 < TOBI_MEANING; c++) {
        const char *close = *c == '[' ? strchr(c, ']') : NULL;
        if (close && close[1] == '(' && strchr(close, ')')) end = close;
        else if (c == end) c = strchr(c, ')');
        else if (*c != '\n') room[used++] = *c;
    }
    room[used] = '\0';
    tobi_text_mend(room);
    return room;
}

tobi_status tobi_set_language(const char *name, tobi_error *err)
{
    TOBI_NEED(name, "the name of the language");
    const int ja = strcmp(name, "ja") == 0;
    if (!ja && strcmp(name, "en") != 0)
        return tobi_fail(err, TOBI_INVALID, "there is no language '%.40s'; allowed are en and ja", name);
    if (ja) tobi_texts_sort(), tobi_page_texts_sort();
    is_japanese = ja;
    return TOBI_OK;
}

/* For the catalogue: the usual ones, as the C library says them. */
static const char *const reasons[] __attribute__((unused)) = {
    TR("No such file or directory"), TR("Permission denied"), TR("Operation not permitted"),
    TR("Is a directory"),
    TR("Not a directory"), TR("File exists"), TR("No space left on device"), TR("Disk quota exceeded"),
    TR("Read-only file system"), TR("Input/output error"), TR("File too large"), TR("File name too long"),
    TR("Cannot allocate memory"), TR("Too many open files"), TR("Too many levels of symbolic links"),
    TR("Device or resource busy"), TR("Resource temporarily unavailable"), TR("Text file busy")
};

const char *tobi_reason(int code) { return tr(strerror(code)); }

void tobi_text_mend(char *text)
{
    size_t length = strlen(text), n = length;
    while (n > 0 && ((unsigned char)text[n - 1] & 0xc0) == 0x80) n--;
    if (n == 0 || (unsigned char)text[n - 1] < 0xc0) return;
    const unsigned char lead = (unsigned char)text[n - 1];
    const size_t whole = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (length - (n - 1) < whole) text[n - 1] = '\0';
}
