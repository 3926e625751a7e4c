/* What a script's process and the process that loaded it share. A question and its answer lie in
   shared memory; one byte through a socket hands over the turn. The loader believes nothing that it
   reads here: numbers are checked, texts are cut. */
#pragma once
#include "rigid/script.h"
#include <jansson.h>

enum { TOBI_SCRIPT_BATCH = 8192, TOBI_SCRIPT_MEMORY = 64 << 20 /* bytes */ };

typedef enum tobi_script_question {
    TOBI_ASK_LOAD,
    TOBI_ASK_WALK,       /* deform() or velocity() for a batch of points                    */
    TOBI_ASK_PLACE,
    TOBI_ASK_CONTROL
} tobi_script_question;

typedef enum tobi_script_answer {
    TOBI_ANSWER_NONE,    /* not yet, and never if the process has ended                     */
    TOBI_ANSWER_DONE,
    TOBI_ANSWER_FAILED,  /* text says why                                                   */
    TOBI_ANSWER_FULL,    /* the memory limit                                                */
    TOBI_ANSWER_LATE     /* the time limit; text is "file:line: " or empty; the process has ended */
} tobi_script_answer;

typedef struct tobi_script_channel {
    tobi_script_question question;
    tobi_script_answer answer;
    int64_t count;                            /* of points asked for | of values that place answered       */
    double time;                              /* s                                                         */
    double at;                                /* number of the point in work                               */
    double from[TOBI_SCRIPT_BATCH][3];        /* points | what control sees                                */
    double to[TOBI_SCRIPT_BATCH][3];          /* points | what place or control answered                   */
    double pivot[3];                          /* m, set by loading                                         */
    int rigid;                                /* 1: the script has place, set by loading                   */
    char hold[64], text[1024];
} tobi_script_channel;

/* What a script is made of. */
typedef struct tobi_script_job {
    tobi_script_role role;
    const char *name;                         /* of the file, for messages                                 */
    const char *text;
    size_t length;
    const json_t *params;
    double seconds;                           /* processor time per question                               */
} tobi_script_job;

/* The whole life of the process, from the fork to its end: loads the script, then answers questions
   until the other end of the socket is closed. All signals are blocked when it is called. */
_Noreturn void tobi_script_serve(const tobi_script_job *job, tobi_script_channel *channel, int fd);
