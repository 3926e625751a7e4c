/* Number types of arrays: fields of particles, arrays in files. */
#pragma once
#include <stddef.h>

typedef enum tobi_type { TOBI_F32, TOBI_F64, TOBI_I32, TOBI_I64, TOBI_U8 } tobi_type;

/* Bytes of one number; 0 for a value that is not a type. */
static inline size_t tobi_type_size(tobi_type type)
{
    static const unsigned char size[] = { 4, 8, 4, 8, 1 };
    return (unsigned)type < sizeof size ? size[type] : 0;
}
