/* Defaults, range checks and look-up by name over parameter tables: one reading of a table serves
   every use. Drawback: a rule between two members of a definition is not in its table (world/rules.c). */
#include "base/param.h"
#include <math.h>
#include <string.h>

static void *member(void *def, const tobi_param *p) { return (char *)def + p->offset; }

void tobi_param_defaults(const tobi_param_table *table, void *def)
{
    memset(def, 0, table->size);
    for (const tobi_param *p = table->rows; p->key; p++) {
        switch (p->type) {
        case TOBI_PARAM_REAL: memcpy(member(def, p), p->def, sizeof(double)); break;
        case TOBI_PARAM_VEC3: memcpy(member(def, p), p->def, 3*sizeof(double)); break;
        case TOBI_PARAM_TEXT: memcpy(member(def, p), &p->text, sizeof p->text); break;
        case TOBI_PARAM_INT:
        case TOBI_PARAM_BOOL:
        case TOBI_PARAM_CHOICE: {
            int value = (int)p->def[0];
            memcpy(member(def, p), &value, sizeof value);
            break;
        }
        }
    }
}

double tobi_param_word(const tobi_param *p) { return p->def[0] < p->min ? p->def[0] : 0; }

static tobi_status check_value(const tobi_param_table *table, const tobi_param *p, double v,
                               tobi_error *err)
{
    const char *unit = p->type == TOBI_PARAM_CHOICE || strcmp(p->unit, "1") == 0 ? "" : p->unit;
    if (!isfinite(v))
        return tobi_fail(err, TOBI_INVALID, "%s.%s is not a finite number", table->name, p->key);
    if (p->text && v == tobi_param_word(p)) return TOBI_OK;
    if (v < p->min || v > p->max)
        return tobi_fail(err, TOBI_INVALID, "%s.%s is %g, allowed is %g to %g%s%s", table->name, p->key, v,
                         p->min, p->max, *unit ? " " : "", unit);
    return TOBI_OK;
}

static tobi_status check_text(const tobi_param_table *table, const tobi_param *p, const void *at,
                              tobi_error *err)
{
    const char *text;
    memcpy(&text, at, sizeof text);
    const size_t bytes = text && strcmp(p->unit, "name") == 0 ? strlen(text) : 0;
    if (bytes > TOBI_NAME_BYTES)
        return tobi_fail(err, TOBI_INVALID, "%s.%s has %zu bytes, allowed are up to %d", table->name, p->key,
                         bytes, TOBI_NAME_BYTES);
    for (size_t k = 0; k < bytes; k++)              /* it becomes a cell of a table */
        if ((unsigned char)text[k] < ' ' || text[k] == 127 || strchr(",\"", text[k]))
            return tobi_fail(err, TOBI_INVALID, "%s.%s has a comma, a quote or a control character at byte "
                             "%zu", table->name, p->key, k);
    return TOBI_OK;
}

tobi_status tobi_param_check(const tobi_param_table *table, const void *def, tobi_error *err)
{
    for (const tobi_param *p = table->rows; p->key; p++) {
        const char *at = (const char *)def + p->offset;
        double v[3];
        int n = 1, i;
        switch (p->type) {
        case TOBI_PARAM_REAL: memcpy(v, at, sizeof(double)); break;
        case TOBI_PARAM_VEC3:
            memcpy(v, at, sizeof v);
            n = p->text && memcmp(v, p->def, sizeof v) == 0 ? 0 : 3;      /* the word's value */
            break;
        case TOBI_PARAM_TEXT: TOBI_TRY(check_text(table, p, at, err)); continue;
        default: memcpy(&i, at, sizeof i); v[0] = i; break;
        }
        for (i = 0; i < n; i++) TOBI_TRY(check_value(table, p, v[i], err));
    }
    return TOBI_OK;
}

const char *tobi_choice_word(const char *choices, int i, int *length)
{
    for (const char *word = choices; word; i--) {
        const char *bar = strchr(word, '|');
        *length = (int)(bar ? (size_t)(bar - word) : strlen(word));
        if (i == 0) return word;
        word = bar ? bar + 1 : NULL;
    }
    return NULL;
}

int tobi_choice_count(const char *choices)
{
    int count = 1;
    for (const char *c = choices; *c; c++) count += *c == '|';
    return count;
}
