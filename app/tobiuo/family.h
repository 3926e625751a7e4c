/* Families of scenes that `tobiuo new` writes: their options, and the writers. */
#pragma once
#include "language.h"
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
/* new.c: 1 if the option was given, its default or not. */
int is_given(const family_choice *c, const char *option);

#define SPACING(d) { "spacing", "m", d, 1e-7, 1e5, TEXT("particle spacing"), 0 }
#define LENGTH(name_, def_, doc_) { name_, "m", def_, 1e-6, 1e5, doc_, 0 }
#define ACROSS(name_, def_, doc_) { name_, "m", def_, 1e-6, 1e5, doc_, 1 }

/* families.c: parts of a scene. A place has x along the tank, z up, y left out in 2-D. */
void put_place(const family_choice *c, FILE *out, double x, double y, double z);
void put_corners(const family_choice *c, FILE *out, const double low[3], const double high[3]);
/* All up to the spacing: the box from 0 to size, gravity g along -z turned by `tilt` degrees about y. */
void put_head(const family_choice *c, FILE *out, const double size[3], const char *title, double tilt);
void put_water(const family_choice *c, FILE *out, const double low[3], const double high[3]);
/* A sensor; kind "point" or "level". Text before the first: "", before others ",". */
void put_probe(const family_choice *c, FILE *out, int first, const char *name, const char *kind,
               double x, double y, double z);

/* family_waves.c */
extern const family_option wave_options[];
const char *object_wave(const family_choice *c);
void write_wave(const family_choice *c, FILE *out);
