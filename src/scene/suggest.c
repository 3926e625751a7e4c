/* The nearest known word by the number of edits, swaps included: one edit, and one more for every four
   letters. Or else the only one that the word is the beginning of. Drawback: words of more than 40 letters
   get no suggestion. */
#include "tobiuo/scene.h"
#include <ctype.h>
#include <string.h>

enum { LONGEST = 40 };

static int fold(char c) { return c == '-' ? '_' : tolower((unsigned char)c); }

static int least(int a, int b) { return a < b ? a : b; }

/* Edit distance with swaps of neighbours (optimal string alignment). */
static int measure_distance(const char *a, const char *b)
{
    int n = (int)strlen(a), m = (int)strlen(b);
    int row[3][LONGEST + 1];
    for (int j = 0; j <= m; j++) row[0][j] = j;
    for (int i = 1; i <= n; i++) {
        int *now = row[i%3], *last = row[(i + 2)%3], *before = row[(i + 1)%3];
        now[0] = i;
        for (int j = 1; j <= m; j++) {
            int same = fold(a[i - 1]) == fold(b[j - 1]);
            now[j] = least(least(last[j], now[j - 1]) + 1, last[j - 1] + !same);
            if (i > 1 && j > 1 && fold(a[i - 1]) == fold(b[j - 2]) &&
                fold(a[i - 2]) == fold(b[j - 1]))
                now[j] = least(now[j], before[j - 2] + 1);
        }
    }
    return row[n%3][m];
}

/* "young" for youngs_modulus; NULL if several begin so. */
static const char *find_longer(const char *word, int length, const char *const *candidates, size_t count)
{
    const char *found = NULL;
    for (size_t i = 0; length >= 3 && i < count; i++) {
        int k = 0;
        while (k < length && fold(word[k]) == fold(candidates[i][k])) k++;
        if (k < length) continue;
        if (found) return NULL;
        found = candidates[i];
    }
    return found;
}

const char *tobi_suggest(const char *word, const char *const *candidates, size_t count)
{
    const char *best = NULL;
    if (!word || !candidates) return NULL;
    int length = strlen(word) > LONGEST ? LONGEST + 1 : (int)strlen(word);
    int limit = 1 + length/4;       /* one slip in a short word, more in a long one */
    if (length > LONGEST) return NULL;
    for (size_t i = 0; i < count; i++) {
        if (strlen(candidates[i]) > LONGEST) continue;
        int distance = measure_distance(word, candidates[i]);
        if (distance > limit || distance >= length) continue;
        best = candidates[i];
        limit = distance - 1;
    }
    return best ? best : find_longer(word, length, candidates, count);
}
