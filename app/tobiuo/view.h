/* The window of a run that goes on. */
#pragma once
#include "app.h"
#include "../window/window.h"

/* As drive, with a window beside it; without a display it says so and drives on. keys: see window_def. */
int drive_with_window(tobi_world *world, tobi_run *run, const drive_options *o, const tobi_scene *scene,
                      const char *keys);
