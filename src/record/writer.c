/* The thread of a run that turns snapshots into files, beside the steps.

   The caller's thread hands over at most two snapshots: one in work, one that waits; then it waits
   itself, so that memory stays bounded. What cannot be written stays at the head of the queue: the
   failure is told by the caller's next call and then tried again; unless the run goes on, see trouble.c.
   The thread reads of run and world only what no step changes: names, triangles, counts, parameters.
   Drawback: a full disk is told a few steps late. */
#include "exec/exec.h"
#include "record/record.h"
#include "world/world.h"
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>

enum { QUEUE = 2 };

struct tobi_writer {
    tobi_run *run;
    pthread_t thread;
    pthread_mutex_t lock;                 /* of all below                            */
    pthread_cond_t changed;
    tobi_snapshot *queue[QUEUE];          /* the first is in work                    */
    int count;
    bool failed, stop;                    /* failed: and nobody was told yet         */
    tobi_error error;
};

/* A row of history.csv comes last: it says that everything of this output is on disk. */
static tobi_status write_files(tobi_run *run, tobi_snapshot *snapshot, tobi_error *err)
{
    const tobi_status kept = tobi_record_keep_dir(run, err);
    /* Without room for a folder its files fail, too, and are noted. */
    if (kept != TOBI_OK && !(kept == TOBI_IO && run->goes_on)) return kept;
    tobi_status status = tobi_series_write(run, snapshot, err);
    if (status == TOBI_IO && (run->goes_on || tobi_record_is_folder_gone(run))) {
        TOBI_TRY(tobi_record_keep_dir(run, err));
        status = tobi_series_write(run, snapshot, err);
    }
    return status == TOBI_OK ? tobi_tables_write(run, snapshot, err) : status;
}

static void *work(void *user)
{
    struct tobi_writer *w = user;
    tobi_error error = { 0 };
    tobi_exec_set_default(w->run->world->sim.exec.threads);
    pthread_mutex_lock(&w->lock);
    for (;;) {
        while (!w->stop && (w->count == 0 || w->failed)) pthread_cond_wait(&w->changed, &w->lock);
        if (w->count == 0 || w->failed) break;
        tobi_snapshot *snapshot = w->queue[0];
        pthread_mutex_unlock(&w->lock);
        tobi_status status = write_files(w->run, snapshot, &error);
        if (status == TOBI_OK) tobi_snapshot_free(snapshot);
        pthread_mutex_lock(&w->lock);
        w->failed = status != TOBI_OK;
        if (w->failed) w->error = error;
        else w->queue[0] = w->queue[--w->count];
        pthread_cond_broadcast(&w->changed);
    }
    pthread_mutex_unlock(&w->lock);
    return NULL;
}

tobi_status tobi_writer_start(tobi_run *run, tobi_error *err)
{
    struct tobi_writer *w = calloc(1, sizeof *w);
    if (!w) return tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    w->run = run;
    w->lock = (pthread_mutex_t)PTHREAD_MUTEX_INITIALIZER;
    w->changed = (pthread_cond_t)PTHREAD_COND_INITIALIZER;
    /* Signals are for the caller's threads. */
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int code = pthread_create(&w->thread, NULL, work, w);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (code == 0) {
        run->writer = w;
        return TOBI_OK;
    }
    free(w);
    return tobi_fail(err, TOBI_NO_MEMORY, "run: no thread to write the results");
}

/* With the lock. From now on the writer tries again. */
static tobi_status tell_failure(struct tobi_writer *w, tobi_error *err)
{
    if (!w->failed) return TOBI_OK;
    w->failed = false;
    pthread_cond_broadcast(&w->changed);
    return tobi_fail(err, w->error.status, "%s", w->error.text);
}

tobi_status tobi_writer_check(struct tobi_writer *w, tobi_error *err)
{
    pthread_mutex_lock(&w->lock);
    tobi_status status = tell_failure(w, err);
    pthread_mutex_unlock(&w->lock);
    return status;
}

/* Until there are fewer snapshots than `limit`; the lock is held after it. */
static tobi_status wait_below(struct tobi_writer *w, int limit, tobi_error *err)
{
    pthread_mutex_lock(&w->lock);
    while (w->count >= limit && !w->failed) pthread_cond_wait(&w->changed, &w->lock);
    return tell_failure(w, err);
}

tobi_status tobi_writer_put(struct tobi_writer *w, tobi_snapshot *snapshot, tobi_error *err)
{
    tobi_status status = wait_below(w, QUEUE, err);
    if (status == TOBI_OK) w->queue[w->count++] = snapshot;
    pthread_cond_broadcast(&w->changed);
    pthread_mutex_unlock(&w->lock);
    return status;
}

tobi_status tobi_writer_wait(struct tobi_writer *w, tobi_error *err)
{
    tobi_status status = wait_below(w, 1, err);
    pthread_mutex_unlock(&w->lock);
    return status;
}

int tobi_writer_pending(struct tobi_writer *w)
{
    pthread_mutex_lock(&w->lock);
    int count = w->count;
    pthread_mutex_unlock(&w->lock);
    return count;
}

void tobi_writer_free(struct tobi_writer *w)
{
    if (!w) return;
    pthread_mutex_lock(&w->lock);
    w->stop = true;
    pthread_cond_broadcast(&w->changed);
    pthread_mutex_unlock(&w->lock);
    pthread_join(w->thread, NULL);
    for (int k = 0; k < w->count; k++) tobi_snapshot_free(w->queue[k]);
    free(w);
}
