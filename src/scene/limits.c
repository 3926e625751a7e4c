/* What a row of a parameter table allows and takes by default, in words. Drawback: each kind of limit has its
   own sentence. */
#include "scene/bind.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Of the words of limits: pages of keys are English, mistakes in that of the user. */
typedef const char *(*translation)(const char *english);
static const char *keep_english(const char *english) { return english; }

/* "a, b or c" from "a|b|c". */
static void list_choices(const char *choices, translation say, char *text, size_t size)
{
    int count = tobi_choice_count(choices), length;
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < count && used < size; i++) {
        const char *word = tobi_choice_word(choices, i, &length);
        used += (size_t)snprintf(text + used, size - used, "%s%.*s",
                                 i == 0 ? "" : i == count - 1 ? say(TR(" or ")) : ", ", length, word);
    }
}

/* Powers of ten as 1e7 and 1e-7. */
static void write_limit(double v, char text[32])
{
    const int exponent = v != 0 ? (int)round(log10(fabs(v))) : 0, is_power = fabs(v) == pow(10, exponent);
    if (is_power && (exponent > 4 || exponent < -3)) snprintf(text, 32, "%s1e%d", v < 0 ? "-" : "", exponent);
    else snprintf(text, 32, "%.10g", v);
}

static void say_limits(const tobi_param *row, translation say, char *text, size_t size)
{
    const char *unit = row->unit && strcmp(row->unit, "1") != 0 ? row->unit : "";
    const char *gap = unit[0] ? " " : "";
    char numbers[TOBI_NOTE];
    if (row->type == TOBI_PARAM_CHOICE) {
        list_choices(row->choices, say, text, size);
        return;
    }
    if (row->type == TOBI_PARAM_BOOL || row->type == TOBI_PARAM_TEXT) {
        snprintf(text, size, "%s", row->type == TOBI_PARAM_BOOL ? say(TR("true or false")) : say(TR("any")));
        return;
    }
    if (row->positive && isnan(row->max))
        snprintf(numbers, sizeof numbers, say(TR("greater than 0%s%s")), gap, unit);
    else if (isnan(row->min) && isnan(row->max))
        snprintf(numbers, sizeof numbers, say(gap[0] ? TR("any number in%s%s") : TR("any number%s%s")), gap,
                 unit);
    else if (isnan(row->max))
        snprintf(numbers, sizeof numbers, say(TR("at least %.10g%s%s")), row->min, gap, unit);
    else if (isnan(row->min))
        snprintf(numbers, sizeof numbers, say(TR("at most %.10g%s%s")), row->max, gap, unit);
    else {
        char low[32], high[32];
        write_limit(row->min, low);
        write_limit(row->max, high);
        snprintf(numbers, sizeof numbers, say(TR("%s to %s%s%s")), low, high, gap, unit);
    }
    if (row->text) snprintf(text, size, say(TR("%s, or \"%s\"")), numbers, row->text);
    else snprintf(text, size, "%s", numbers);
}

void tobi_bind_limits(const tobi_param *row, char *text, size_t size)
{
    say_limits(row, keep_english, text, size);
}

void tobi_bind_say_limits(const tobi_param *row, char *text, size_t size)
{
    say_limits(row, tobi_text, text, size);
}

void tobi_bind_default(const tobi_param *row, char *text, size_t size)
{
    int length = 0;
    const char *word;
    if (row->required) snprintf(text, size, "required");
    else if (row->type == TOBI_PARAM_TEXT)
        snprintf(text, size, "%s", row->text ? row->text : "none");
    else if (row->type == TOBI_PARAM_BOOL)
        snprintf(text, size, "%s", row->def[0] != 0 ? "true" : "false");
    else if (row->type == TOBI_PARAM_CHOICE) {
        word = tobi_choice_word(row->choices, (int)row->def[0], &length);
        snprintf(text, size, "%.*s", length, word);
    } else if (row->type == TOBI_PARAM_VEC3 && row->text) snprintf(text, size, "%s", row->text);
    else if (row->type == TOBI_PARAM_VEC3)
        snprintf(text, size, "[%.10g, %.10g, %.10g]", row->def[0], row->def[1], row->def[2]);
    else if (row->text && row->def[0] == tobi_param_word(row)) snprintf(text, size, "%s", row->text);
    else snprintf(text, size, "%.10g", row->def[0]);
}
