/* What a script's process and the process that loaded it share. A request and its reply lie in
   shared memory; one byte through a socket says that it is there. The loader believes nothing that it
   reads here: numbers are checked, texts are cut. */
#pragma once
#include "rigid/script.h"
#include <jansson.h>

enum { TOBI_SCRIPT_BATCH = 8192, TOBI_SCRIPT_MEMORY = 64 << 20 /* bytes */ };

typedef enum tobi_script_request {
    TOBI_REQUEST_LOAD,
    TOBI_REQUEST_WALK,       /* deform() or velocity() for a batch of points                    */
    TOBI_REQUEST_PLACE,
    TOBI_REQUEST_CONTROL
} tobi_script_request;

typedef enum tobi_script_reply {
    TOBI_REPLY_NONE,    /* not yet, and never if the process has ended                     */
    TOBI_REPLY_DONE,
    TOBI_REPLY_FAILED,  /* text says why                                                   */
    TOBI_REPLY_FULL,    /* the memory limit                                                */
    TOBI_REPLY_LATE     /* the time limit; text is "file:line: " or empty; the process has ended */
} tobi_script_reply;

typedef struct tobi_script_channel {
    tobi_script_request request;
    tobi_script_reply reply;
    int64_t count;                            /* of points asked for | of values that place answered       */
    double time;                              /* s                                                         */
    double at;                                /* number of the point in work                               */
    double from[TOBI_SCRIPT_BATCH][3];        /* points | what control sees                                */
    double to[TOBI_SCRIPT_BATCH][3];          /* points | what place or control answered                   */
    double steer[3];                          /* for deform                                                */
    double pivot[3];                          /* m, set by loading                                         */
    int rigid;                                /* 1: the script has place, set by loading                   */
    char joint[TOBI_CONTROL_JOINTS][64];      /* names of the `count` joints that control sees             */
    char hold[64], text[1024];
} tobi_script_channel;

/* What a script is made of. */
typedef struct tobi_script_job {
    tobi_script_role role;
    const char *name;                         /* of the file, for messages                                 */
    const char *text;
    size_t length;
    const json_t *params;
    double seconds;                           /* processor time per request                               */
} tobi_script_job;

/* The whole life of the process, from the fork to its end: loads the script, then serves requests
   until the other end of the socket is closed. All signals are blocked when it is called. */
_Noreturn void tobi_script_serve(const tobi_script_job *job, tobi_script_channel *channel, int fd);
