/* The keys of the window, and what the help says of them. */
#pragma once
#include "viewer.h"

typedef struct key_row {
    int key;                        /* 0: not a key; -1: the end of the list                         */
    const char *name, *does;        /* a line of the help; NULL: it has none                         */
    void (*act)(viewer *v);
} key_row;

extern const key_row key_rows[];
