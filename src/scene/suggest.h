/* "Did you mean": the nearest of some words by edit distance. */
#pragma once
#include <stddef.h>

/* The candidate nearest to word if it is near enough to be a slip of the pen, or else NULL.
   Case, '-' and '_' do not count. */
const char *tobi_suggest(const char *word, const char *const *candidates, size_t count);
