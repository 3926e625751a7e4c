/* What could not be written while the run goes on: counted by kind of file, told once per kind. The writer's
   thread and the caller's note here. Drawback: the reason of the first failure of a kind stands for all. */
#define _GNU_SOURCE 1
#include "record/record.h"
#include <stdlib.h>

static const struct { const char *name; bool per_output; } kinds[TOBI_KINDS] = {
    [TOBI_KIND_PARTICLES] = { TR("files of particles"), true },
    [TOBI_KIND_SURFACES] = { TR("surfaces"), true },
    [TOBI_KIND_COPIES] = { TR("STL, PLY and OBJ files"), true },
    [TOBI_KIND_PICTURES] = { TR("pictures"), true },
    [TOBI_KIND_LISTS] = { TR("lists (*.pvd)"), false },
    [TOBI_KIND_TABLES] = { TR("rows of tables"), false },
    [TOBI_KIND_CHECKPOINTS] = { TR("the last checkpoint"), false },
    [TOBI_KIND_SUMMARY] = { "summary.json", false },
};

static void add_told(tobi_run *run, char *text)
{
    run->told[run->told_count] = text;
    __atomic_store_n(&run->told_count, run->told_count + 1, __ATOMIC_RELEASE);
}

/* Of a kind the first failure; the text lives as long as the run. A nest tells by the run around it. */
static void tell(tobi_run *run, tobi_record_kind kind, const char *reason)
{
    static const char *const what[TOBI_KINDS] = {
        [TOBI_KIND_LISTS] = TR("; the list of before stays"),
        [TOBI_KIND_TABLES] = TR("; its rows wait for room"),
        [TOBI_KIND_CHECKPOINTS] = TR("; the checkpoint of before stays"),
    };
    char *text = NULL;
    if (run->trouble[kind].told) return;
    run->trouble[kind].told = true;
    if (asprintf(&text, tr("%s%s; the run goes on"), reason, what[kind] ? tr(what[kind])
                 : tr(": left out")) < 0) return;
    if (!run->outer) {
        add_told(run, text);
        return;
    }
    pthread_mutex_lock(&run->outer->trouble_lock);
    add_told(run->outer, text);
    pthread_mutex_unlock(&run->outer->trouble_lock);
}

tobi_status tobi_trouble_pass(tobi_run *run, tobi_record_kind kind, int64_t output, tobi_status status,
                              const tobi_error *err)
{
    if (!run->goes_on || (status != TOBI_OK && status != TOBI_IO)) return status;
    pthread_mutex_lock(&run->trouble_lock);
    tobi_trouble *t = &run->trouble[kind];
    t->fails = status == TOBI_IO;
    if (t->fails) {
        if (t->files == 0) t->first = output;
        t->last = output;
        t->files = kinds[kind].per_output ? t->files + 1 : 1;
        tell(run, kind, err ? err->text : tr("a file cannot be written"));
    } else if (!kinds[kind].per_output) t->files = 0;
    pthread_mutex_unlock(&run->trouble_lock);
    return TOBI_OK;
}

bool tobi_trouble_lasts(tobi_run *run, tobi_record_kind kind)
{
    pthread_mutex_lock(&run->trouble_lock);
    const bool fails = run->trouble[kind].fails;
    pthread_mutex_unlock(&run->trouble_lock);
    return fails;
}

static int64_t count(tobi_run *run, int kind)
{
    if (kind == TOBI_KIND_TABLES) return tobi_tables_waiting(run);
    pthread_mutex_lock(&run->trouble_lock);
    const int64_t files = run->trouble[kind].files;
    pthread_mutex_unlock(&run->trouble_lock);
    return files;
}

int tobi_trouble_write(tobi_run *run, char *text, size_t room)
{
    int at = 0;
    for (int k = 0; k < TOBI_KINDS; k++) {
        const tobi_trouble *t = &run->trouble[k];
        const long long files = (long long)count(run, k);
        if (files == 0 || at >= (int)room - 1) continue;
        const size_t left = room - (size_t)at;
        if (kinds[k].per_output)
            at += snprintf(text + at, left, tr("%s not written: %lld, of outputs %lld to %lld; "),
                           tr(kinds[k].name),
                           files, (long long)t->first, (long long)t->last);
        else if (k == TOBI_KIND_TABLES)
            at += snprintf(text + at, left, tr("%s not written: %lld; "), tr(kinds[k].name), files);
        else at += snprintf(text + at, left, tr("not written: %s; "), tr(kinds[k].name));
    }
    return at < (int)room ? at : (int)room - 1;
}

void tobi_run_go_on(tobi_run *run, int on)
{
    tobi_csv *tables[TOBI_TABLES];
    if (!run) return;
    tobi_tables_list(run, tables);
    run->goes_on = on != 0;
    for (int k = 0; k < run->nest_count; k++) tobi_run_go_on(run->nest[k], on);
    for (int k = 0; k < TOBI_TABLES; k++)
        if (tables[k]) tobi_csv_set_patient(tables[k], on);
}

const char *tobi_run_trouble(const tobi_run *run, int index)
{
    const int told = run ? __atomic_load_n(&run->told_count, __ATOMIC_ACQUIRE) : 0;
    return index >= 0 && index < told ? run->told[index] : NULL;
}

int64_t tobi_run_unwritten(tobi_run *run)
{
    int64_t sum = 0;
    for (int k = 0; run && k < TOBI_KINDS; k++) sum += count(run, k);
    for (int k = 0; run && k < run->nest_count; k++) sum += tobi_run_unwritten(run->nest[k]);
    return sum;
}

void tobi_trouble_free(tobi_run *run)
{
    for (int k = 0; k < run->told_count; k++) free(run->told[k]);
}
