/* Between the thread that steps a world and the window. The window asks for a moment; the steps' thread
   copies it out between two steps, so that nobody else ever touches the world. Reading changes nothing: the
   run has the same bits as without a window. */
#pragma once
#include "tobiuo/results.h"
#include "tobiuo/tobiuo.h"

typedef struct live live;
typedef enum live_end { LIVE_STAYS, LIVE_GOES_ON, LIVE_STOPS } live_end;

/* NULL without memory. */
live *live_create(void);
void live_free(live *l);

/* --- the steps' thread --- */
/* Called before each step: gives the moment that the window has asked for, waits while it pauses. is_stopped:
   ends a pause. 1: the run is to stop. */
int live_between(live *l, tobi_world *world, int (*is_stopped)(void));
/* After the last step; says that there are no more. */
void live_end_steps(live *l, tobi_world *world);

/* --- the window's thread --- */
/* For a moment that is newer than the last one; again: for one in any case. */
void live_ask(live *l, int again);
/* 1: *moment is a new one, the caller's from now on. */
int live_take(live *l, tobi_moment *moment);
void live_pause(live *l, int paused);
void live_step(live *l);
void live_leave(live *l, live_end how);
int live_has_ended(live *l);
/* s of simulated time, of the last step. */
double live_time(live *l);
/* Calls wake(user) from the steps' thread when there is something to take. */
void live_set_wake(live *l, void (*wake)(void *user), void *user);
