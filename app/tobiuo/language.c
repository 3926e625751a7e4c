/* English texts and their Japanese: the catalogue ja.po as a table, by CMake. The locale of the C
   library is not asked: a machine on which no Japanese one was generated has only "C". Drawback: each
   text is compared with all. */
#include "language.h"
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const struct { const char *english, *japanese; } texts[] = {
    { NULL, NULL
#include "japanese.inc"
    }
};

static int is_japanese;

const char *tr(const char *text)
{
    for (size_t k = 1; is_japanese && *text && k < sizeof texts/sizeof *texts; k++)
        if (strcmp(texts[k].english, text) == 0 && *texts[k].japanese) return texts[k].japanese;
    return text;
}

/* Of a Japanese user, by the first variable that says anything. */
static int asks_for_japanese(void)
{
    static const char *const variables[] = { "LC_ALL", "LC_MESSAGES", "LANG" };
    for (int k = 0; k < 3; k++) {
        const char *value = getenv(variables[k]);
        if (value && *value) return strncmp(value, "ja", 2) == 0;
    }
    return 0;
}

int choose_language(const char *name)
{
    if (name && strcmp(name, "ja") != 0 && strcmp(name, "en") != 0) return -1;
    is_japanese = name ? strcmp(name, "ja") == 0 : asks_for_japanese();
    return 0;
}

const char *language_name(void) { return is_japanese ? "ja" : "en"; }
