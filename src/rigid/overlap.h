/* How deep two bodies are in each other, whatever contact makes of it. */
#pragma once
#include "rigid/touch.h"

/* Twice the radius of the largest ball that lies in both bodies, m, to 10 %: of two boxes that overlap along
   faces how far. 0 if it is at most least (m): what lies shallower is contact's to tell. *whole = 0: the
   search would have taken too long and was given up; there may be deeper ones. */
double tobi_overlap_depth(const tobi_body *a, const tobi_shape *sa, const tobi_body *b, const tobi_shape *sb,
                          double least, int *whole);
