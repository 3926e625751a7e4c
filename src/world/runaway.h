/* Speeds that end a run. */
#pragma once
#include "core/system.h"

/* After a step. TOBI_DIVERGED, with time, particle, place and what may help, when a speed is no number or
   above what the scene allows. */
tobi_status tobi_runaway_check(const tobi_system *s, tobi_error *err);
