/* English texts and their Japanese: the catalogue ja.po as a table, by CMake. The locale of the C
   library is not asked: a machine on which no Japanese one was generated has only "C". Drawback: the
   two tables are searched for a text of the library. */
#include "language.h"
#include "tobiuo/tobiuo.h"
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

void app_texts_sort(void);
const char *app_texts_find(const char *text) __attribute__((format_arg(1)));

static int is_japanese;

const char *tr(const char *text)
{
    const char *own = is_japanese ? app_texts_find(text) : text;
    return own == text ? tobi_text(text) : own;
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
    if (is_japanese) app_texts_sort();
    tobi_set_language(language_name(), NULL);
    return 0;
}

const char *language_name(void) { return is_japanese ? "ja" : "en"; }
