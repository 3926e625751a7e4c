/* Where the rows of a grid lie in memory: rows along x are grouped in strips along y, then z, so that the
   rows a sweep touches stay in cache whatever the width of the domain. */
#pragma once
#include "exec/portable.h"

/* Index of the first of the n[0] cells of the row (y, z); `strip` rows along y are kept together. */
TOBI_FN int64_t tobi_strip_row(const int n[3], int strip, int y, int z)
{
    const int k = y/strip;
    return (((int64_t)k*n[2] + z)*strip + (y - k*strip))*n[0];
}
