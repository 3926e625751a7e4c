/* Families of scenes that `tobiuo new` writes: their options, and the writers. */
#pragma once
#include <stdio.h>

/* A number that a family takes; a length in m if unit says so. */
typedef struct family_option {
    const char *name, *unit;
    double def, min, max;
    const char *doc;
    int across;                        /* 1: along y of the tank, which a 2-D scene does not have */
} family_option;

enum { FAMILY_OPTIONS = 24 };

/* What somebody chose; value and given follow the options of the family, then those of all. */
typedef struct family_choice {
    const struct family *family;
    double value[FAMILY_OPTIONS];
    int given[FAMILY_OPTIONS];
    const char *method;                /* "isph" */
    int method_given;
    int dimension;
} family_choice;

typedef struct family {
    const char *name, *doc;
    const family_option *options;      /* ended by a row without name; spacing and until come first */
    int flat;                          /* 1: it may be 2-D                                          */
    /* What the choice makes impossible, NULL: nothing; the text is static. */
    const char *(*object)(const family_choice *c);
    void (*write)(const family_choice *c, FILE *out);
} family;

/* families.c: by index, NULL past the end. */
const family *family_at(int index);
/* new.c: options that all have. */
const family_option *family_common(void);

/* The option by its index: of the family first, then of all; NULL past the end. */
const family_option *family_option_at(const family *f, int index);
double chosen(const family_choice *c, const char *option);
