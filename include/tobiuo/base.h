/* Status codes and export marks shared by every public header. */
#ifndef TOBIUO_BASE_H
#define TOBIUO_BASE_H
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#  define TOBI_API __attribute__((visibility("default")))
#else
#  define TOBI_API
#endif

#define TOBI_VERSION "0.1.0"

#ifdef __cplusplus
extern "C" {
#endif

/* What a call can answer. TOBI_OK is zero; everything else comes with a text in the tobi_error. */
#define TOBI_STATUS_LIST(X)                                                        \
    X(TOBI_OK,          "ok")                                                      \
    X(TOBI_INVALID,     "invalid input")                                           \
    X(TOBI_NOT_FOUND,   "not found")                                               \
    X(TOBI_IO,          "input/output failure")                                    \
    X(TOBI_NO_MEMORY,   "out of memory")                                           \
    X(TOBI_DIVERGED,    "the simulation diverged")                                 \
    X(TOBI_SCRIPT,      "error in a user script")                                  \
    X(TOBI_UNSUPPORTED, "not supported by this build or method")                   \
    X(TOBI_DAMAGED,     "damaged file")                                            \
    X(TOBI_STALLED,     "the simulation gets nowhere")                             \
    X(TOBI_STOPPED,     "stopped on request")

typedef enum tobi_status {
#define X(code, text) code,
    TOBI_STATUS_LIST(X)
#undef X
} tobi_status;

/* Where a failing call leaves its explanation: what, where, what is allowed. Plain value, owned by
   the caller; the library never prints. A NULL pointer is accepted everywhere and drops the text. */
typedef struct tobi_error {
    tobi_status status;
    char text[2048];
    char key[64];          /* of the definition that a call refuses, as "fill[0].level"; "" if none is known.
                              From a start and a step it begins at the scene: "fluids[0].fill[0].level" */
} tobi_error;

#ifdef __cplusplus
}
#endif
#endif
