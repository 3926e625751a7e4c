/* Bounds for a child process that does work which may go wrong. */
#pragma once
#include <stdint.h>

/* No core file, and at most `bytes` of address space on top of what is mapped now (nothing is done where that
   cannot be known, and under the address sanitizer). */
void tobi_limit_memory(uint64_t bytes);
