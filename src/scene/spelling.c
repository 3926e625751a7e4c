/* Words that are spelt in two ways; the tables have one of them. Drawback: a word with two such parts has its
   other spelling in the first of them only. */
#include "scene/spelling.h"
#include <stdio.h>
#include <string.h>

static const char *const pairs[][2] = { { "centre", "center" }, { "color", "colour" }, { "gray", "grey" } };

int tobi_spelling_other(const char *word, char other[TOBI_SPELLING])
{
    for (size_t k = 0; k < sizeof pairs/sizeof *pairs; k++)
        for (int side = 0; side < 2; side++) {
            const char *mine = pairs[k][side], *at = strstr(word, mine);
            if (!at || strlen(word) + 2 > TOBI_SPELLING) continue;
            snprintf(other, TOBI_SPELLING, "%.*s%s%s", (int)(at - word), word, pairs[k][1 - side],
                     at + strlen(mine));
            return 1;
        }
    return 0;
}
